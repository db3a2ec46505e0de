// Files under models/: whatever the bytes are, every reader gives a model or an InputError, nothing else.

#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <string>

#include "base/error.h"
#include "world/brain_file.h"
#include "world/measured_model.h"
#include "world/needle_file.h"
#include "world/needle_model.h"
#include "world/scene_file.h"
#include "world/vessel_file.h"
#include "world/wall_file.h"

namespace {

template <class Reader>
void read(Reader reader) {
  try {
    reader();
  } catch (const filum::InputError&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const int file = memfd_create("model", 0);
  if (file < 0 || write(file, data, size) != static_cast<ssize_t>(size)) __builtin_trap();
  const std::string path = "/proc/self/fd/" + std::to_string(file);
  read([&] {
    filum::ContactMaterial contact;
    const filum::RodMaterial m = filum::load_suture(path, contact);
    if (!(m.radius > 0.0 && m.EA > 0.0 && m.EI > 0.0 && m.GJ > 0.0)) __builtin_trap();
  });
  read([&] { filum::load_instrument(path); });
  read([&] { filum::load_needle(path); });
  read([&] { filum::load_track(path); });
  read([&] { filum::load_vessel(path); });
  read([&] { filum::load_blade(path); });
  read([&] { filum::MeasuredModel::load(path); });
  close(file);
  return 0;
}
