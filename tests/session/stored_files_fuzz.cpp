// What a store keeps. A database goes to the reader that its application id names: a store's index (set aside and built anew where damaged),
// its ratings, else a recording. Other bytes are the packed records of a recording's blocks, which checksums keep from a database's mutants:
// the first byte says of what, the second how many.

#include "fuzz_folder.h"
#include "session/ratings.h"
#include "session/recording_reader.h"
#include "session/store.h"

namespace {

using namespace filum;

template <class Cursor, class Record>
void drain(Cursor cursor, Record record) {
  for (int n = 0; n < 10000 && cursor.next(record);) ++n;
}

void read_recording(const fuzz::Folder& folder, std::string_view bytes) {
  const RecordingReader recording(folder.write("recording", bytes));
  drain(recording.steps(), StepRecord());
  drain(recording.samples(), SampleRecord());
  drain(recording.events(), EventRecord());
  drain(recording.array_hashes(), ArrayHashRecord());
  recording.find_damage();
  recording.last_step();
}

void read_index(const fuzz::Folder& folder, std::string_view bytes) {
  std::filesystem::remove_all(folder.file("store"));
  std::filesystem::create_directory(folder.file("store"));
  folder.write("store/index.sqlite", bytes);
  const Store store(folder.file("store"));
  store.list();
  store.check(true);
}

void read_ratings(const fuzz::Folder& folder, std::string_view bytes) {
  folder.write("ratings.sqlite", bytes);
  Ratings(folder.path()).list();
}

template <class Record, class... Tools>
void unpack_and_pack(std::span<const char> bytes, std::size_t count, Tools... tools) {
  std::vector<Record> records;
  if (!unpack(bytes, count, tools..., records)) return;
  std::vector<char> packed;
  pack(std::span<const Record>(records), tools..., packed);
  if (records.size() != count || packed.size() != bytes.size()) std::abort();
}

void read_blocks(std::string_view bytes) {
  if (bytes.size() < 2) return;
  const int kind = static_cast<unsigned char>(bytes[0]) % 8;
  const auto count = static_cast<std::size_t>(static_cast<unsigned char>(bytes[1]));
  const std::span<const char> block(bytes.data() + 2, bytes.size() - 2);
  std::vector<EventRecord> events;
  if (kind < 4) unpack_and_pack<StepRecord>(block, count, kind);
  else if (kind == 4) unpack_and_pack<SampleRecord>(block, count);
  else if (kind == 5) unpack_and_pack<EventRecord>(block, count);
  else if (kind == 7) unpack_without_text(block, count, events);
  else unpack_and_pack<ArrayHashRecord>(block, count);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::Folder folder;
  const std::string_view bytes = fuzz::text_of(data, size);
  if (!bytes.starts_with("SQLite format 3")) {
    read_blocks(bytes);
    return 0;
  }
  const std::string_view id = size >= 72 ? bytes.substr(68, 4) : "";
  fuzz::read([&] {
    if (id == "FiLx") read_index(folder, bytes);
    else if (id == "FiLr") read_ratings(folder, bytes);
    else read_recording(folder, bytes);
  });
  return 0;
}
