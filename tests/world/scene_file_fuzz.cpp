// Scenes of curricula/ and the models they name: whatever the bytes are, a scene or an InputError, nothing else.

#include "fuzz_folder.h"
#include "world/world.h"

namespace {

/// A root with the models of this one, a brain of few elements (models/brain/fuzz.yaml) and one task.
struct Root : filum::fuzz::Folder {
  Root() {
    namespace fs = std::filesystem;
    fs::create_directories(file("curricula/fuzz"));
    fs::create_directories(file("models/brain"));
    for (const auto& entry : fs::directory_iterator(fs::path(FILUM_SOURCE_DIR) / "models"))
      if (entry.path().filename() != "brain") fs::create_directory_symlink(entry.path(), file("models/" + entry.path().filename().string()));
    fs::copy_file(fs::path(FILUM_SOURCE_DIR) / "tests/world/corpus/model_file/brain.yaml", file("models/brain/fuzz.yaml"));
  }
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace filum;
  static const Root root;
  root.write("curricula/fuzz/scene.yaml", fuzz::text_of(data, size));
  fuzz::read([] {
    if (!load_model(root.path(), "fuzz")) std::abort();
  });
  return 0;
}
