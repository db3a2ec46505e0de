#include "session/records.h"

#include <bit>
#include <cstring>

namespace filum {
namespace {

static_assert(std::endian::native == std::endian::little, "the packed form is little-endian");

class Writer {
 public:
  explicit Writer(std::vector<char>& bytes) : bytes_(bytes) {}
  template <class T>
  void put(const T& value) {
    static_assert(std::is_arithmetic_v<T>);
    const char* begin = reinterpret_cast<const char*>(&value);
    bytes_.insert(bytes_.end(), begin, begin + sizeof value);
  }
  void put(const Pose& pose) {
    for (int i = 0; i < 3; ++i) put(pose.p[i]);
    for (int i = 0; i < 4; ++i) put(pose.q.coeffs()[i]);
  }
  template <std::size_t N>
  void put(const FixedText<N>& text) {
    const std::string_view view = text.view();
    put(static_cast<std::uint8_t>(view.size()));
    bytes_.insert(bytes_.end(), view.begin(), view.end());
  }

 private:
  std::vector<char>& bytes_;
};

class Reader {
 public:
  explicit Reader(std::span<const char> bytes) : bytes_(bytes) {}
  template <class T>
  void get(T& value) {
    static_assert(std::is_arithmetic_v<T>);
    if (bytes_.size() < sizeof value) return fail();
    std::memcpy(&value, bytes_.data(), sizeof value);
    bytes_ = bytes_.subspan(sizeof value);
  }
  void get(Pose& pose) {
    for (int i = 0; i < 3; ++i) get(pose.p[i]);
    for (int i = 0; i < 4; ++i) get(pose.q.coeffs()[i]);
  }
  template <std::size_t N>
  void get(FixedText<N>& text) {
    std::uint8_t size = 0;
    get(size);
    if (size >= N || bytes_.size() < size) return fail();
    text = FixedText<N>(std::string_view(bytes_.data(), size));
    if (text.view().size() != size) return fail();  // a zero within: put() writes none
    bytes_ = bytes_.subspan(size);
  }
  bool ok() const { return ok_; }
  bool at_end() const { return ok_ && bytes_.empty(); }

 private:
  void fail() { ok_ = false; }
  std::span<const char> bytes_;
  bool ok_ = true;
};

constexpr std::uint8_t kPose = 1, kAngle = 2, kForce = 4, kValid = 8;

void put_one(Writer& out, const StepRecord& record, int n_tools) {
  out.put(record.step);
  out.put(record.host_time_us);
  out.put(record.compute_us);
  out.put(record.state_hash);
  for (int i = 0; i < n_tools; ++i) {
    const ToolInput& tool = record.inputs.tools[static_cast<std::size_t>(i)];
    out.put(static_cast<std::uint8_t>((tool.has_grip_force ? kForce : 0) | (tool.valid ? kValid : 0)));
    out.put(tool.X_WD);
    out.put(tool.grip_angle);
    out.put(tool.grip_force);
    out.put(tool.buttons);
  }
}

void get_one(Reader& in, StepRecord& record, int n_tools) {
  in.get(record.step);
  in.get(record.host_time_us);
  in.get(record.compute_us);
  in.get(record.state_hash);
  for (int i = 0; i < n_tools; ++i) {
    ToolInput& tool = record.inputs.tools[static_cast<std::size_t>(i)];
    std::uint8_t flags = 0;
    in.get(flags);
    tool.has_grip_force = (flags & kForce) != 0;
    tool.valid = (flags & kValid) != 0;
    in.get(tool.X_WD);
    in.get(tool.grip_angle);
    in.get(tool.grip_force);
    in.get(tool.buttons);
  }
}

void put_one(Writer& out, const SampleRecord& record) {
  out.put(static_cast<std::uint8_t>((record.has_pose ? kPose : 0) | (record.has_grip_angle ? kAngle : 0) |
                                    (record.has_grip_force ? kForce : 0)));
  out.put(static_cast<std::int8_t>(record.tool));
  out.put(record.host_time_us);
  out.put(record.device_time_us);
  out.put(record.sequence);
  if (record.has_pose) out.put(record.X_WD);
  if (record.has_grip_angle) out.put(record.grip_angle);
  if (record.has_grip_force) out.put(record.grip_force);
  out.put(record.raw_angle);
  out.put(record.raw_force);
  out.put(record.buttons);
}

void get_one(Reader& in, SampleRecord& record) {
  std::uint8_t flags = 0;
  std::int8_t tool = 0;
  in.get(flags);
  in.get(tool);
  record.tool = tool;
  record.has_pose = (flags & kPose) != 0;
  record.has_grip_angle = (flags & kAngle) != 0;
  record.has_grip_force = (flags & kForce) != 0;
  in.get(record.host_time_us);
  in.get(record.device_time_us);
  in.get(record.sequence);
  if (record.has_pose) in.get(record.X_WD);
  if (record.has_grip_angle) in.get(record.grip_angle);
  if (record.has_grip_force) in.get(record.grip_force);
  in.get(record.raw_angle);
  in.get(record.raw_force);
  in.get(record.buttons);
}

void put_one(Writer& out, const EventRecord& record) {
  out.put(record.step);
  out.put(record.time);
  out.put(record.name);
  out.put(static_cast<std::int8_t>(record.tool));
  out.put(record.value);
  out.put(record.unit);
  out.put(record.text);
}

void get_one(Reader& in, EventRecord& record, bool with_text) {
  in.get(record.step);
  in.get(record.time);
  in.get(record.name);
  std::int8_t tool = 0;
  in.get(tool);
  record.tool = tool;
  in.get(record.value);
  in.get(record.unit);
  if (with_text) in.get(record.text);
}

void put_one(Writer& out, const ArrayHashRecord& record) {
  out.put(record.step);
  out.put(record.name);
  out.put(record.hash);
}

void get_one(Reader& in, ArrayHashRecord& record) {
  in.get(record.step);
  in.get(record.name);
  in.get(record.hash);
}

template <class Record, class... More>
void pack_all(std::span<const Record> records, std::vector<char>& bytes, More... more) {
  bytes.clear();
  Writer out(bytes);
  for (const Record& record : records) put_one(out, record, more...);
}

template <class Record, class... More>
bool unpack_all(std::span<const char> bytes, std::size_t count, std::vector<Record>& records, More... more) {
  records.clear();
  Reader in(bytes);
  for (std::size_t i = 0; i < count && in.ok(); ++i) {
    records.emplace_back();
    get_one(in, records.back(), more...);
  }
  return in.at_end();
}

}  // namespace

void pack(std::span<const StepRecord> records, int n_tools, std::vector<char>& bytes) {
  pack_all(records, bytes, n_tools);
}
void pack(std::span<const SampleRecord> records, std::vector<char>& bytes) {
  pack_all(records, bytes);
}
void pack(std::span<const EventRecord> records, std::vector<char>& bytes) {
  pack_all(records, bytes);
}
void pack(std::span<const ArrayHashRecord> records, std::vector<char>& bytes) {
  pack_all(records, bytes);
}

bool unpack(std::span<const char> bytes, std::size_t count, int n_tools, std::vector<StepRecord>& records) {
  return unpack_all(bytes, count, records, n_tools);
}
bool unpack(std::span<const char> bytes, std::size_t count, std::vector<SampleRecord>& records) {
  return unpack_all(bytes, count, records);
}
bool unpack(std::span<const char> bytes, std::size_t count, std::vector<EventRecord>& records) {
  return unpack_all(bytes, count, records, true);
}
bool unpack_without_text(std::span<const char> bytes, std::size_t count, std::vector<EventRecord>& records) {
  return unpack_all(bytes, count, records, false);
}
bool unpack(std::span<const char> bytes, std::size_t count, std::vector<ArrayHashRecord>& records) {
  return unpack_all(bytes, count, records);
}

bool is_participant_code(std::string_view code) noexcept {
  if (code.empty() || code.size() > 32) return false;
  for (const char c : code) {
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    const bool digit = c >= '0' && c <= '9';
    if (!letter && !digit && c != '_' && c != '-') return false;
  }
  return true;
}

}  // namespace filum
