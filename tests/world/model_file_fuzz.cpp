// Files under models/, told apart by their format line (any other text goes to every reader): a model or an InputError, nothing else. Brains
// are read as the model of a scene that is sound.

#include "fuzz_folder.h"
#include "world/brain_file.h"
#include "world/measured_model.h"
#include "world/needle_file.h"
#include "world/needle_model.h"
#include "world/scene_file.h"
#include "world/vessel_file.h"
#include "world/wall_file.h"
#include "world/world.h"

namespace {

using namespace filum;

void read_suture(const std::string& path) {
  ContactMaterial contact;
  const RodMaterial m = load_suture(path, contact);
  if (!(m.radius > 0.0 && m.EA > 0.0 && m.EI > 0.0 && m.GJ > 0.0)) std::abort();
}

/// A root with a scene of one blade that the brain is read for.
struct Root : fuzz::Folder {
  Root() {
    std::filesystem::create_directories(file("curricula/fuzz"));
    std::filesystem::create_directories(file("models"));
    std::filesystem::create_directory_symlink(std::string(FILUM_SOURCE_DIR) + "/models/spatula", file("models/spatula"));
    write("curricula/fuzz/scene.yaml",
          "format: filum-brain-scene/1\ntitle: Any brain\nbrain: none\nstep: 5 ms\nblades:\n"
          "  - { model: straight-10, p: [0 mm, -12 mm, 8 mm], handle: [0, 1, 0.05], opening: [-1, 0, 0] }\n");
  }
};

void read_brain(const std::string& path) {
  static const Root root;
  if (!load_model(root.path(), "fuzz", path)) std::abort();
}

struct Reader {
  const char* format;
  void (*read)(const std::string& path);
};

constexpr Reader kReaders[] = {
    {"filum-suture/1", read_suture},
    {"filum-instrument/1", [](const std::string& path) { load_instrument(path); }},
    {"filum-needle/1", [](const std::string& path) { load_needle(path); }},
    {"filum-track/1", [](const std::string& path) { load_track(path); }},
    {"filum-vessel/1", [](const std::string& path) { load_vessel(path); }},
    {"filum-spatula/1", [](const std::string& path) { load_blade(path); }},
    {"filum-model/1", [](const std::string& path) { MeasuredModel::load(path); }},
    {"filum-brain/1", read_brain},
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::Folder folder;
  const std::string_view text = fuzz::text_of(data, size), format = fuzz::format_of(text);
  const std::string path = folder.write("model.yaml", text);
  bool known = false;
  for (const Reader& r : kReaders) known = known || format == r.format;
  for (const Reader& r : kReaders)
    if (!known || format == r.format) fuzz::read([&] { r.read(path); });
  return 0;
}
