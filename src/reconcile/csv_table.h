#pragma once
// Strict CSV (RFC 4180, UTF-8, dot decimal, one header row). Cells are numbers or empty (missing). Beside the text itself a cell takes 8 bytes, so that the
// largest file (256 MiB, 5 million rows, 20 million cells) takes half a gigabyte while it is read.

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace filum::reconcile {

struct CsvTable {
  std::string file;
  std::vector<std::string> header;
  std::vector<int> line;  // in the file, of each row

  static constexpr std::size_t kMostRows = 5'000'000, kMostCells = 20'000'000;

  static CsvTable load(const std::string& path);
  /// Refuses more than `most_rows` rows.
  static CsvTable parse(std::string text, const std::string& file, std::size_t most_rows = kMostRows);

  std::size_t rows() const { return line.size(); }
  std::string_view cell(std::size_t row, std::size_t column) const;

  /// Index of a column; throws InputError where there is none or two.
  int column(const std::string& name) const;
  /// The column as numbers, NaN where empty; throws InputError where there is no such column, and for anything else that is not a finite number.
  Eigen::VectorXd numbers(int column) const;

  /// Where a cell stands in the text.
  struct Span {
    std::uint32_t at = 0, size = 0;
  };

 private:
  std::string text_;          // quoted cells without their quotes
  std::vector<Span> cells_;   // row after row, each as long as the header
};

}  // namespace filum::reconcile
