// CSV: whatever the bytes are, a table with as many cells in each row as in its header, or an InputError.

#include <cstddef>
#include <cstdint>
#include <string>

#include "base/error.h"
#include "reconcile/csv_table.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using filum::reconcile::CsvTable;
  try {
    const CsvTable table = CsvTable::parse(std::string(reinterpret_cast<const char*>(data), size), "fuzz.csv");
    if (table.line.size() != table.rows.size()) __builtin_trap();
    for (const auto& row : table.rows)
      if (row.size() != table.header.size()) __builtin_trap();
    for (std::size_t k = 0; k < table.header.size(); ++k) {
      const auto values = table.numbers(static_cast<int>(k));
      if (values.size() != static_cast<Eigen::Index>(table.rows.size())) __builtin_trap();
    }
  } catch (const filum::InputError&) {
  }
  return 0;
}
