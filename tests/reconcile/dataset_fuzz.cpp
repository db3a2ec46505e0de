// A dataset's description beside sound samples, in four columns: whatever its bytes are, a dataset or an InputError. A description that names
// experiment.yaml as its model is read as that, too.

#include "fuzz_folder.h"
#include "reconcile/dataset.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace filum;
  static const fuzz::Folder folder;
  static const std::string samples = folder.write("a.csv", "t,u,F,G\n0,0,0,1\n1,-0.1,-1,1.1\n2,-0.2,-2,1.2\n3,-0.3,-3,1.1\n");
  folder.write("experiment.yaml", fuzz::text_of(data, size));
  fuzz::read([] {
    const reconcile::Dataset d = reconcile::load_dataset(folder.path(), FILUM_SOURCE_DIR);
    if (d.trials.empty()) std::abort();
    for (const reconcile::Trial& t : d.trials)
      for (const auto& [name, values] : t.data)
        if (values.size() != t.time.size()) std::abort();
  });
  return 0;
}
