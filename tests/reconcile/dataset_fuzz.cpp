// A dataset's description beside sound samples: whatever its bytes are, a dataset or an InputError.

#include <cstddef>
#include <cstdint>
#include <string>

#include "base/error.h"
#include "reconcile/dataset.h"
#include "records.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace filum::reconcile;
  static const Folder folder;
  static const bool written = (folder.write("a.csv", "t,u,F\n0,0,0\n1,-0.1,-1\n2,-0.2,-2\n3,-0.3,-3\n"), true);
  folder.write("experiment.yaml", std::string(reinterpret_cast<const char*>(data), size));
  try {
    const Dataset d = load_dataset(folder.path(), FILUM_SOURCE_DIR);
    if (!written || d.trials.empty()) __builtin_trap();
    for (const Trial& t : d.trials)
      for (const auto& [name, values] : t.data)
        if (values.size() != t.time.size()) __builtin_trap();
  } catch (const filum::InputError&) {
  }
  return 0;
}
