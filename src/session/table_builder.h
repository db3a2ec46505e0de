#pragma once
// Fills a table row by row. Private to session.

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "session/export.h"

namespace filum {

/// Builds a table column by column in the order of the first row; add(name...) appends one cell of the
/// current row.
class TableBuilder {
 public:
  TableBuilder(std::string name, double rate, std::string meaning) {
    table_.name = std::move(name);
    table_.rate = rate;
    table_.meaning = std::move(meaning);
  }
  void new_row() { at_ = 0; }
  void add(const std::string& name, const char* unit, const std::string& meaning, double value) {
    column<std::vector<double>>(name, unit, meaning).push_back(value);
  }
  void add_integer(const std::string& name, const char* unit, const std::string& meaning,
                   std::int64_t value) {
    column<std::vector<std::int64_t>>(name, unit, meaning).push_back(value);
  }
  void add_text(const std::string& name, const char* unit, const std::string& meaning, std::string value) {
    column<std::vector<std::string>>(name, unit, meaning).push_back(std::move(value));
  }
  void add_vector(const std::string& name, const char* unit, const std::string& meaning, const Vec3& value) {
    constexpr const char* kAxes[] = {"_x", "_y", "_z"};
    for (int i = 0; i < 3; ++i) add(name + kAxes[i], unit, meaning, value[i]);
  }
  void add_quaternion(const std::string& name, const std::string& meaning, const Quat& value) {
    add(name + "_w", "-", meaning, value.w());
    add(name + "_x", "-", meaning, value.x());
    add(name + "_y", "-", meaning, value.y());
    add(name + "_z", "-", meaning, value.z());
  }
  Table take() { return std::move(table_); }

 private:
  template <class Values>
  Values& column(const std::string& name, const char* unit, const std::string& meaning) {
    if (at_ == table_.columns.size()) table_.columns.push_back({name, unit, meaning, Values{}});
    return std::get<Values>(table_.columns[at_++].values);
  }

  Table table_;
  std::size_t at_ = 0;
};

/// [Hz], of the tables with one row a step.
inline double step_rate(const RecordingMeta& meta) {
  return meta.dt > 0.0 ? 1.0 / meta.dt : 0.0;
}

}  // namespace filum
