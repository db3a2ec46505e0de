// Any bytes in place of a recording either read as one or give an InputError.

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <string>

#include "base/error.h"
#include "session/recording_reader.h"

namespace {

/// A file in memory with a path of its own.
std::string path_with(const std::uint8_t* data, std::size_t size) {
  static const int file = memfd_create("recording", 0);
  if (file < 0 || ftruncate(file, 0) != 0 || pwrite(file, data, size, 0) != static_cast<ssize_t>(size)) std::abort();
  return "/proc/self/fd/" + std::to_string(file);
}

template <class Cursor, class Record>
void drain(Cursor cursor, Record record) {
  for (int n = 0; n < 10000 && cursor.next(record);) ++n;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const filum::RecordingReader recording(path_with(data, size));
    drain(recording.steps(), filum::StepRecord());
    drain(recording.samples(), filum::SampleRecord());
    drain(recording.events(), filum::EventRecord());
    drain(recording.array_hashes(), filum::ArrayHashRecord());
  } catch (const filum::InputError&) {
  }
  return 0;
}
