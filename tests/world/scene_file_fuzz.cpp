// Scenes of curricula/ and the models they name: whatever the bytes are, a scene or an InputError, nothing else.

#include "fuzz_folder.h"
#include "world/world.h"

namespace {

/// A root with the models of this one and one task.
struct Root : filum::fuzz::Folder {
  Root() {
    std::filesystem::create_directories(file("curricula/fuzz"));
    std::filesystem::create_directory_symlink(std::string(FILUM_SOURCE_DIR) + "/models", file("models"));
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
