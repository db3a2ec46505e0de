// Any bytes in place of a recording either read as one or give an InputError.

#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>

#include "base/error.h"
#include "session/recording_reader.h"

namespace {

std::string path_to_remove;

/// A file with these bytes; SQLite wants a real path, so it lies in memory only where /dev/shm is there.
std::string path_with(const std::uint8_t* data, std::size_t size) {
  static const std::string path = [] {
    std::string name =
        std::string(::access("/dev/shm", W_OK) == 0 ? "/dev/shm" : "/tmp") + "/filum-fuzz-XXXXXX";
    if (::close(::mkstemp(name.data())) != 0) std::abort();
    std::atexit([] {
      for (const char* suffix : {"", "-wal", "-shm"}) std::remove((path_to_remove + suffix).c_str());
    });
    path_to_remove = name;
    return name;
  }();
  std::ofstream(path, std::ios::binary | std::ios::trunc)
      .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  return path;
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
  try {
    const filum::RecordingReader recording(path_with(data, size));
    recording.find_damage();
    recording.last_step();
  } catch (const filum::InputError&) {
  }
  return 0;
}
