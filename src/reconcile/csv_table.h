#pragma once
// Strict CSV (RFC 4180, UTF-8, dot decimal, one header row). Cells are numbers or empty (missing).

#include <Eigen/Core>
#include <string>
#include <vector>

namespace filum::reconcile {

struct CsvTable {
  std::string file;
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;  // each as long as the header
  std::vector<int> line;                       // in the file, of each row

  static CsvTable load(const std::string& path);
  static CsvTable parse(const std::string& text, const std::string& file);

  /// Index of a column; throws InputError where there is none or two.
  int column(const std::string& name) const;
  /// The column as numbers, NaN where empty; throws InputError where there is no such column, and for anything else that is not a finite number.
  Eigen::VectorXd numbers(int column) const;
};

}  // namespace filum::reconcile
