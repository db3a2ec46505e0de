#include "reconcile/csv_table.h"

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

std::string shown(const std::string& text) {
  std::string out;
  for (const char c : text.substr(0, 40)) out += static_cast<unsigned char>(c) < 0x20 ? '?' : c;
  return "\"" + out + "\"";
}

/// Splits text into records of cells; quotes may hold commas, quotes and line ends.
class Reader {
 public:
  Reader(const std::string& text, const std::string& file) : text_(text), file_(file) {}

  bool next(std::vector<std::string>& cells) {
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
  std::string cell() {
    if (at_ < text_.size() && text_[at_] == '"') return quoted();
    const std::size_t start = at_;
    while (at_ < text_.size() && text_[at_] != ',' && text_[at_] != '\n' && text_[at_] != '\r') ++at_;
    std::string out = text_.substr(start, at_ - start);
    const std::size_t first = out.find_first_not_of(" \t");
    if (first == std::string::npos) return "";
    return out.substr(first, out.find_last_not_of(" \t") - first + 1);
  }

  std::string quoted() {
    std::string out;
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
      out += text_[at_];
    }
    if (at_ < text_.size() && text_[at_] != ',' && text_[at_] != '\n' && text_[at_] != '\r')
      throw InputError(file_ + ":" + std::to_string(line_), "cell", "text behind a closing quote", "a comma or the end of the line");
    return out;
  }

  const std::string& text_;
  std::string file_;
  std::size_t at_ = 0;
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
  char block[65536];
  while (text.size() <= kMaxBytes && (file.read(block, sizeof block) || file.gcount() > 0)) text.append(block, static_cast<std::size_t>(file.gcount()));
  if (!file.eof() || file.bad()) throw InputError(path, "file", "nothing that can be read", "a CSV file");
  return parse(text, path);
}

namespace {

/// What a table from a country of decimal commas looks like.
constexpr const char* kDots = " (cells are separated by commas, and numbers have a dot)";

std::string hint(const std::vector<std::string>& header, const std::vector<std::string>& cells) {
  const std::string& first = cells.empty() ? std::string() : cells[0];
  if (header.size() == 1 && header[0].find_first_of(";\t") != std::string::npos) return kDots;
  return cells.size() > header.size() || first.find(';') != std::string::npos ? kDots : "";
}

}  // namespace

CsvTable CsvTable::parse(const std::string& whole, const std::string& file) {
  if (whole.size() > kMaxBytes) throw InputError(file, "file", "more than 256 MiB", "a CSV file of at most 256 MiB");
  require_utf8(whole, file, "a CSV file");
  const std::string text = whole.rfind("\xEF\xBB\xBF", 0) == 0 ? whole.substr(3) : whole;
  CsvTable table;
  table.file = file;
  Reader reader(text, file);
  if (!reader.next(table.header) || (table.header.size() == 1 && table.header[0].empty()))
    throw InputError(file + ":1", "header", "nothing", "one row with the names of the columns");
  std::vector<std::string> cells;
  while (reader.next(cells)) {
    if (cells.size() == 1 && cells[0].empty() && table.header.size() > 1) continue;  // an empty line at the end
    if (cells.size() != table.header.size())
      throw InputError(file + ":" + std::to_string(reader.line()), "row", std::to_string(cells.size()) + " cells",
                       std::to_string(table.header.size()) + " as in the header" + hint(table.header, cells));
    table.rows.push_back(cells);
    table.line.push_back(reader.line());
  }
  if (table.rows.empty()) throw InputError(file + ":2", "rows", "none", "samples below the header");
  return table;
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
    throw InputError(file + ":1", "header", "columns " + all, "a column named " + shown(name) + hint(header, {}));
  }
  return found;
}

Eigen::VectorXd CsvTable::numbers(int column) const {
  if (column < 0 || column >= static_cast<int>(header.size()))
    throw InputError(file + ":1", "header", std::to_string(header.size()) + " columns", "at least " + std::to_string(column + 1) + " columns");
  Eigen::VectorXd out(static_cast<Eigen::Index>(rows.size()));
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const std::string& cell = rows[r][static_cast<std::size_t>(column)];
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
