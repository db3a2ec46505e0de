#include "reconcile/csv_table.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include "base/error.h"
#include "base/utf8.h"

namespace filum::reconcile {
namespace {

constexpr std::size_t kMaxBytes = 256u << 20;
constexpr double kLargest = 1e30;  // beyond it squares overflow, and no unit asks for it

std::string shown(std::string_view text) {
  std::string out;
  for (const char c : text.substr(0, 40)) out += static_cast<unsigned char>(c) < 0x20 ? '?' : c;
  return "\"" + out + "\"";
}

/// Splits text into records of cells; quotes may hold commas, quotes and line ends. What stands in quotes is put where it stood, less the quotes.
class Reader {
 public:
  Reader(std::string& text, std::size_t from, const std::string& file) : text_(text), file_(file), at_(from) {}

  bool next(std::vector<CsvTable::Span>& cells) {
    cells.clear();
    if (at_ >= text_.size()) return false;
    record_line_ = line_;
    for (;;) {
      cells.push_back(cell());
      if (at_ >= text_.size()) return true;
      const char c = text_[at_++];
      if (c == ',') continue;
      if (c == '\r' && at_ < text_.size() && text_[at_] == '\n') ++at_;
      ++line_;
      return true;
    }
  }
  int line() const { return record_line_; }

 private:
  static CsvTable::Span span(std::size_t from, std::size_t to) { return {static_cast<std::uint32_t>(from), static_cast<std::uint32_t>(to - from)}; }

  CsvTable::Span cell() {
    if (at_ < text_.size() && text_[at_] == '"') return quoted();
    const auto blank = [&](std::size_t k) { return text_[k] == ' ' || text_[k] == '\t'; };
    std::size_t first = at_;
    while (at_ < text_.size() && text_[at_] != ',' && text_[at_] != '\n' && text_[at_] != '\r') ++at_;
    std::size_t last = at_;
    while (first < last && blank(first)) ++first;
    while (first < last && blank(last - 1)) --last;
    return span(first, last);
  }

  CsvTable::Span quoted() {
    const std::size_t from = at_;
    std::size_t to = from;
    ++at_;
    for (;; ++at_) {
      if (at_ >= text_.size()) throw InputError(file_ + ":" + std::to_string(record_line_), "cell", "a quote that is never closed", "\"...\"");
      if (text_[at_] == '"') {
        if (at_ + 1 < text_.size() && text_[at_ + 1] == '"') {
          ++at_;
        } else {
          ++at_;
          break;
        }
      }
      if (text_[at_] == '\n') ++line_;
      text_[to++] = text_[at_];
    }
    if (at_ < text_.size() && text_[at_] != ',' && text_[at_] != '\n' && text_[at_] != '\r')
      throw InputError(file_ + ":" + std::to_string(line_), "cell", "text behind a closing quote", "a comma or the end of the line");
    return span(from, to);
  }

  std::string& text_;
  std::string file_;
  std::size_t at_;
  int line_ = 1;
  int record_line_ = 1;
};

}  // namespace

CsvTable CsvTable::load(const std::string& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) throw InputError(path, "file", "no such file", "a CSV file");
  // a pipe would be waited for, a device read until the memory is full
  if (!std::filesystem::is_regular_file(status)) throw InputError(path, "file", std::filesystem::is_directory(status) ? "a folder" : "a pipe or a device", "a CSV file");
  if (std::filesystem::file_size(path, error) > kMaxBytes && !error) throw InputError(path, "file", "more than 256 MiB", "a CSV file of at most 256 MiB");
  std::ifstream file(path, std::ios::binary);
  std::string text;
  text.reserve(std::min<std::size_t>(kMaxBytes, std::filesystem::file_size(path, error)) + 65536);
  char block[65536];
  while (text.size() <= kMaxBytes && (file.read(block, sizeof block) || file.gcount() > 0)) text.append(block, static_cast<std::size_t>(file.gcount()));
  if (!file.eof() || file.bad()) throw InputError(path, "file", "nothing that can be read", "a CSV file");
  return parse(std::move(text), path);
}

namespace {

/// What a table from a country of decimal commas looks like.
constexpr const char* kDots = " (cells are separated by commas, and numbers have a dot)";

std::string hint(const std::vector<std::string>& header, std::size_t cells, std::string_view first) {
  if (header.size() == 1 && header[0].find_first_of(";\t") != std::string::npos) return kDots;
  return cells > header.size() || first.find(';') != std::string_view::npos ? kDots : "";
}

}  // namespace

CsvTable CsvTable::parse(std::string whole, const std::string& file, std::size_t most_rows) {
  if (whole.size() > kMaxBytes) throw InputError(file, "file", "more than 256 MiB", "a CSV file of at most 256 MiB");
  require_utf8(whole, file, "a CSV file");
  CsvTable table;
  table.file = file;
  table.text_ = std::move(whole);
  Reader reader(table.text_, table.text_.rfind("\xEF\xBB\xBF", 0) == 0 ? 3 : 0, file);
  std::vector<Span> cells;
  const bool any = reader.next(cells);
  for (const Span& c : cells) table.header.emplace_back(table.text_, c.at, c.size);
  if (!any || (table.header.size() == 1 && table.header[0].empty())) throw InputError(file + ":1", "header", "nothing", "one row with the names of the columns");
  while (reader.next(cells)) {
    if (cells.size() == 1 && cells[0].size == 0 && table.header.size() > 1) continue;  // an empty line at the end
    if (cells.size() != table.header.size())
      throw InputError(file + ":" + std::to_string(reader.line()), "row", std::to_string(cells.size()) + " cells",
                       std::to_string(table.header.size()) + " as in the header" + hint(table.header, cells.size(), std::string_view(table.text_).substr(cells[0].at, cells[0].size)));
    if (table.line.size() >= most_rows || table.cells_.size() + cells.size() > kMostCells)
      throw InputError(file + ":" + std::to_string(reader.line()), "rows", "more than " + std::to_string(table.line.size()),
                       "at most " + std::to_string(most_rows) + " rows and " + std::to_string(kMostCells) + " cells: a record of fewer samples, or columns that are channels only");
    table.cells_.insert(table.cells_.end(), cells.begin(), cells.end());
    table.line.push_back(reader.line());
  }
  if (table.line.empty()) throw InputError(file + ":2", "rows", "none", "samples below the header");
  return table;
}

std::string_view CsvTable::cell(std::size_t row, std::size_t column) const {
  const Span& c = cells_[row * header.size() + column];
  return std::string_view(text_).substr(c.at, c.size);
}

int CsvTable::column(const std::string& name) const {
  int found = -1;
  for (std::size_t i = 0; i < header.size(); ++i) {
    if (header[i] != name) continue;
    if (found >= 0) throw InputError(file + ":1", "column " + shown(name), "it twice", "each column once");
    found = static_cast<int>(i);
  }
  if (found < 0) {
    std::string all;
    for (const std::string& h : header) all += (all.empty() ? "" : ", ") + h;
    throw InputError(file + ":1", "header", "columns " + all, "a column named " + shown(name) + hint(header, 0, ""));
  }
  return found;
}

Eigen::VectorXd CsvTable::numbers(int column) const {
  if (column < 0 || column >= static_cast<int>(header.size()))
    throw InputError(file + ":1", "header", std::to_string(header.size()) + " columns", "at least " + std::to_string(column + 1) + " columns");
  Eigen::VectorXd out(static_cast<Eigen::Index>(rows()));
  for (std::size_t r = 0; r < rows(); ++r) {
    const std::string_view cell = this->cell(r, static_cast<std::size_t>(column));
    double value = std::numeric_limits<double>::quiet_NaN();
    if (!cell.empty()) {
      const char* begin = cell.data() + (cell[0] == '+' ? 1 : 0);
      const auto [end, error] = std::from_chars(begin, cell.data() + cell.size(), value);
      if (error != std::errc() || end != cell.data() + cell.size() || !(std::abs(value) < kLargest))
        throw InputError(file + ":" + std::to_string(line[r]), "column " + header[static_cast<std::size_t>(column)], shown(cell),
                         "a finite number with a dot below 1e30, or nothing where the sample is missing");
    }
    out[static_cast<Eigen::Index>(r)] = value;
  }
  return out;
}

}  // namespace filum::reconcile
