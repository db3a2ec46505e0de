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

void read_brain(const std::string& path) {
  if (!load_model(FILUM_SOURCE_DIR, "press-to-target", path)) std::abort();
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
