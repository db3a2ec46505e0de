// CSV: whatever the bytes are, a table with as many cells in each row as in its header, or an InputError. A table that is one then stands for
// every published table that can be imported: datasets or an InputError.

#include "fuzz_folder.h"
#include "reconcile/csv_table.h"
#include "reconcile/importer.h"

namespace {

using namespace filum;
using reconcile::CsvTable;

void check(const CsvTable& table) {
  std::size_t all = 0;
  for (std::size_t i = 0; i < table.rows(); ++i)
    for (std::size_t k = 0; k < table.header.size(); ++k) all += table.cell(i, k).size();
  if (all > (std::size_t{1} << 30)) std::abort();
  for (std::size_t k = 0; k < table.header.size(); ++k)
    if (table.numbers(static_cast<int>(k)).size() != static_cast<Eigen::Index>(table.rows())) std::abort();
}

/// A folder in which every published table is the file `table.csv`.
struct Tables : fuzz::Folder {
  Tables() {
    std::filesystem::create_directories(file("in"));
    for (const char* region : {"cortex", "basal-ganglia", "corona-radiata", "corpus-callosum"})
      for (const char* mode : {"compression", "tension", "shear"}) link(std::string(region) + "_" + mode);
    for (const char* letter : {"F", "XF"})
      for (const char* run : {"10", "20", "30", "005", "01", "05"}) link(std::string(letter) + "_" + run);
    for (const char* cell : {"1", "2", "3", "4"}) link(std::string("3axisCell") + cell + "CalibrationData");
    link("loadingTest");
  }
  void link(const std::string& name) const { std::filesystem::create_symlink(file("table.csv"), file("in/" + name + ".csv")); }
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Tables folder;
  const std::string text(fuzz::text_of(data, size));
  fuzz::read([&] {
    check(CsvTable::parse(text, "fuzz.csv"));
    folder.write("table.csv", text);
    for (const std::string& kind : reconcile::import_kinds()) fuzz::read([&] { reconcile::import_data(kind, folder.file("in"), folder.file("out")); });
  });
  return 0;
}
