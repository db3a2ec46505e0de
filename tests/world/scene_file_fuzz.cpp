// Scenes of curricula/ and the models they name: whatever the bytes are, a scene or an InputError, nothing else.

#include <stdlib.h>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include "base/error.h"
#include "world/world.h"

namespace {

/// A root with the models of this one and one task.
struct Root {
  Root() {
    namespace fs = std::filesystem;
    std::string name = (fs::temp_directory_path() / "scene-fuzz-XXXXXX").string();
    path = ::mkdtemp(name.data());
    fs::create_directories(path + "/curricula/fuzz");
    fs::create_directory_symlink(std::string(FILUM_SOURCE_DIR) + "/models", path + "/models");
  }
  ~Root() { std::filesystem::remove_all(path); }
  std::string path;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Root root;
  std::ofstream(root.path + "/curricula/fuzz/scene.yaml", std::ios::binary).write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  try {
    if (!filum::load_model(root.path, "fuzz")) __builtin_trap();
  } catch (const filum::InputError&) {
  }
  return 0;
}
