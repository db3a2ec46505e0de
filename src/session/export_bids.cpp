// A recording as Motion-BIDS (BIDS 1.9.0, modality "motion"; S. Jeung et al., Sci. Data 11 (2024) 716): one tracking system
// for each tool in the hand's space (readings of the devices as they arrived, times in a LATENCY channel, nothing filled in)
// and one in the scene's space (commanded poses, evenly sampled). Force and counts have no type of their own: MISC.

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/file_kind.h"
#include "base/hash.h"
#include "base/numbers.h"
#include "session/export.h"
#include "session/new_files.h"

namespace filum {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

struct Channel {
  const char* name;
  const char* component;
  const char* type;
  const char* unit;
};
constexpr std::array<Channel, 8> kPoseChannels = {{{"time", "n/a", "LATENCY", "s"},
                                                   {"tip_pos_x", "x", "POS", "m"},
                                                   {"tip_pos_y", "y", "POS", "m"},
                                                   {"tip_pos_z", "z", "POS", "m"},
                                                   {"tip_quat_x", "quat_x", "ORNT", "n/a"},
                                                   {"tip_quat_y", "quat_y", "ORNT", "n/a"},
                                                   {"tip_quat_z", "quat_z", "ORNT", "n/a"},
                                                   {"tip_quat_w", "quat_w", "ORNT", "n/a"}}};
constexpr std::array<Channel, 2> kGripChannels = {{{"grip_angle", "n/a", "MISC", "rad"}, {"grip_force", "n/a", "MISC", "N"}}};
constexpr std::array<Channel, 3> kRawChannels = {{{"raw_angle", "n/a", "MISC", "n/a"}, {"raw_force", "n/a", "MISC", "n/a"}, {"flags", "n/a", "MISC", "n/a"}}};

constexpr const char* kUnknown = "unknown";

/// Labels are letters and digits only.
std::string label(const std::string& text) {
  std::string out;
  for (const char c : text)
    if (std::isalnum(static_cast<unsigned char>(c))) out += c;
  return out.empty() ? kUnknown : out;
}

/// Codes that differ in other signs only (P_1, P-1, P1) are different people: what was left out is told by eight digits of a hash.
std::string person_label(const std::string& code) {
  std::string out = label(code);
  if (code.empty() || (out == code && code != kUnknown)) return out;
  char digits[9];
  std::snprintf(digits, sizeof digits, "%08x", static_cast<unsigned>(hash_text(code) & 0xffffffffu));
  return out + digits;
}

bool same_bytes(const std::string& a, const std::string& b) {
  std::ifstream first(a, std::ios::binary), second(b, std::ios::binary);
  using Bytes = std::istreambuf_iterator<char>;
  return first && second && std::equal(Bytes(first), {}, Bytes(second), {});
}

/// The files of one export to a dataset, which others share (NewFiles has a folder aside instead): written beside their places, and put there when all of them are on disk.
class Files {
 public:
  /// `own`: folder of this recording's files; what lies outside it is shared by all of the dataset.
  Files(const fs::path& root, fs::path own) : own_(std::move(own), root.string()) {}
  /// Leaves nothing that was not put in its place.
  ~Files() {
    std::error_code ignored;
    for (const std::string& place : places_) fs::remove(part(place), ignored);
  }
  Files(const Files&) = delete;
  Files& operator=(const Files&) = delete;

  static std::string part(const std::string& place) { return place + ".part"; }
  void add(const std::string& place) { places_.push_back(place); }
  const std::vector<std::string>& places() const { return places_; }
  /// The same recording again is no other one: its files have the same bytes.
  std::vector<std::string> put() const {
    for (const std::string& place : places_)
      if (fs::path(place).parent_path() == own_.path() && is_there(place) && !same_bytes(place, part(place)))
        throw InputError(place, "export", "a file of another recording or program", "a folder without it: an export is never written over");
    for (const std::string& place : places_) fs::rename(part(place), place);
    return places_;
  }

 private:
  MadeFolder own_;
  std::vector<std::string> places_;
};

class TextOut {
 public:
  TextOut(const fs::path& place, Files& files) : place_(place.string()), stream_(Files::part(place_)) {
    if (!stream_) throw InputError(place_, "export", "a write error", "a folder that can be written");
    files.add(place_);
  }
  ~TextOut() noexcept(false) {
    if (std::uncaught_exceptions() == 0) close();
  }
  /// For one that is held by what may not throw as it ends.
  void close() {
    if (!stream_.is_open()) return;
    stream_.close();
    if (!stream_) throw_unwritten(place_);
  }
  TextOut& operator<<(const std::string& text) {
    stream_ << text;
    return *this;
  }

 private:
  std::string place_;
  std::ofstream stream_;
};

std::string number(double value) {
  if (!std::isfinite(value)) return "n/a";
  char text[32];
  const auto result = std::to_chars(text, text + sizeof text, value);
  return {text, result.ptr};
}

std::string row_of(const std::vector<double>& cells) {
  std::string row;
  for (const double cell : cells) {
    if (!row.empty()) row += '\t';
    row += number(cell);
  }
  row += '\n';
  return row;
}

void add_pose(std::vector<double>& cells, const Pose* X) {
  for (int i = 0; i < 3; ++i) cells.push_back(X ? X->p[i] : kNaN);
  for (int i = 0; i < 4; ++i) cells.push_back(X ? X->q.coeffs()[i] : kNaN);  // x y z w
}

/// Names of the files of one recording.
struct Names {
  fs::path root, motion;
  std::string subject, session, prefix;  // "sub-P01_ses-..._task-tiphold"
  Names(const RecordingMeta& meta, const std::string& folder) : root(folder) {
    subject = "sub-" + person_label(meta.participant);
    session = "ses-" + label(meta.started_utc);
    prefix = subject + "_" + session + "_task-" + label(meta.task);
    motion = root / subject / session / "motion";
  }
};

/// Rate of a series as it came: readings less one over the time between the first and the last. [Hz]
struct Rate {
  double first = kNaN, last = kNaN;
  std::size_t n = 0;
  void take(double t) {
    if (n++ == 0) first = t;
    last = t;
  }
  double value() const { return n > 1 && last > first ? static_cast<double>(n - 1) / (last - first) : 0.0; }
};

void write_channels(const Names& names, const std::string& system, const std::string& point, bool raw, Files& files) {
  TextOut out(names.motion / (names.prefix + "_tracksys-" + system + "_channels.tsv"), files);
  out << "name\tcomponent\ttype\ttracked_point\tunits\n";
  const auto put = [&](const Channel& c) {
    out << std::string(c.name) + "\t" + c.component + "\t" + c.type + "\t" + point + "\t" + c.unit + "\n";
  };
  for (const Channel& c : kPoseChannels) put(c);
  for (const Channel& c : kGripChannels) put(c);
  if (raw)
    for (const Channel& c : kRawChannels) put(c);
}

void write_sidecar(const Names& names, const std::string& system, const RecordingMeta& meta, const Rate& rate, bool hand,
                   Files& files) {
  const int misc = hand ? 5 : 2;
  const Json json = {{"TaskName", meta.task},
                     {"TaskDescription", "Task of the microsurgery trainer Filum"},
                     {"TrackingSystemName", system},
                     {"SamplingFrequency", hand ? rate.value() : (meta.dt > 0.0 ? 1.0 / meta.dt : 0.0)},
                     {"SamplingFrequencyEffective", rate.value()},
                     {"MotionChannelCount", 8 + misc},
                     {"LATENCYChannelCount", 1},
                     {"POSChannelCount", 3},
                     {"ORNTChannelCount", 4},
                     {"MISCChannelCount", misc},
                     {"TrackedPointsCount", 1},
                     {"MissingValues", "n/a"},
                     {"Manufacturer", hand ? meta.input : "Filum"},
                     {"SoftwareVersions", meta.program},
                     {"RecordingDuration", rate.n > 1 ? rate.last - rate.first : 0.0}};
  TextOut(names.motion / (names.prefix + "_tracksys-" + system + "_motion.json"), files) << json.dump(2) + "\n";
}

void finish_system(const Names& names, const std::string& system, const RecordingMeta& meta, const Rate& rate, bool hand,
                   Files& files) {
  write_channels(names, system, "tip", hand, files);
  write_sidecar(names, system, meta, rate, hand, files);
}

void write_hand(const RecordingReader& recording, const Names& names, int tool, Files& files) {
  const std::string system = "hand" + std::to_string(tool);
  Rate rate;
  {
    std::unique_ptr<TextOut> out;  // only where there are readings
    SampleRecord s;
    std::int64_t start = 0;
    for (auto cursor = recording.samples(); cursor.next(s);) {
      if (s.tool != tool) continue;
      if (!out) {
        out = std::make_unique<TextOut>(names.motion / (names.prefix + "_tracksys-" + system + "_motion.tsv"), files);
        start = s.host_time_us;
      }
      // Not the devices' own times: several devices may move one tool, and the clock of one may begin anew.
      std::vector<double> cells{1e-6 * static_cast<double>(s.host_time_us - start)};
      rate.take(cells.front());
      add_pose(cells, s.has_pose ? &s.X_WD : nullptr);
      cells.push_back(s.has_grip_angle ? s.grip_angle : kNaN);
      cells.push_back(s.has_grip_force ? s.grip_force : kNaN);
      cells.push_back(s.raw_angle);
      cells.push_back(s.raw_force);
      cells.push_back(s.buttons);
      *out << row_of(cells);
    }
    if (!out) return;
    out->close();
  }
  finish_system(names, system, recording.meta(), rate, true, files);
}

void write_scene(const RecordingReader& recording, const Names& names, int tool, Files& files) {
  const std::string system = "scene" + std::to_string(tool);
  const RecordingMeta& meta = recording.meta();
  Rate rate;
  {
    TextOut out(names.motion / (names.prefix + "_tracksys-" + system + "_motion.tsv"), files);
    StepRecord record;
    for (auto cursor = recording.steps(); cursor.next(record);) {
      const ToolInput& in = record.inputs.tools[static_cast<std::size_t>(tool)];
      std::vector<double> cells{static_cast<double>(record.step) * meta.dt};
      rate.take(cells.front());
      add_pose(cells, in.valid ? &in.X_WD : nullptr);
      cells.push_back(in.valid ? in.grip_angle : kNaN);
      cells.push_back(in.has_grip_force ? in.grip_force : kNaN);
      out << row_of(cells);
    }
  }
  finish_system(names, system, meta, rate, false, files);
}

/// Text in one cell of a table whose columns are parted by tabs.
std::string cell_of(std::string_view text) {
  std::string cell(text);
  std::replace_if(cell.begin(), cell.end(), [](char c) { return c == '\t' || c == '\n' || c == '\r'; }, ' ');
  return cell.empty() ? "n/a" : cell;
}

void write_events(const RecordingReader& recording, const Names& names, Files& files) {
  {
    TextOut out(names.motion / (names.prefix + "_events.tsv"), files);
    out << "onset\tduration\ttrial_type\ttool\tmeasured\tunit\ttext\n";
    EventRecord e;
    for (auto cursor = recording.events(); cursor.next(e);) {
      const std::string unit(e.unit.view());
      out << number(e.time) + "\t0\t" + std::string(e.name.view()) + "\t" + (e.tool < 0 ? "n/a" : std::to_string(e.tool)) + "\t" +
                 number(e.value) + "\t" + (unit == "-" || unit.empty() ? "n/a" : unit) + "\t" + cell_of(e.text.view()) + "\n";
    }
  }
  const Json json = {{"trial_type", {{"LongName", "Event"}, {"Description", "What happened in the scene, the task or to a device"}}},
                     {"tool", {{"Description", "Index of the tool, n/a for none"}}},
                     {"measured", {{"Description", "What the event measured, in the unit of the next column"}}},
                     {"unit", {{"Description", "Unit of the column measured"}}},
                     {"text", {{"Description", "The same in words for people, n/a where there are none"}}}};
  TextOut(names.motion / (names.prefix + "_events.json"), files) << json.dump(2) + "\n";
}

/// Adds rows to a table that several recordings share, each once.
void add_rows(const fs::path& path, const std::string& head, const std::vector<std::string>& rows, Files& files) {
  std::string text;
  if (std::ifstream before(path); before) text.assign(std::istreambuf_iterator<char>(before), {});
  if (text.empty()) text = head + "\n";
  for (const std::string& row : rows)
    if (text.find("\n" + row + "\n") == std::string::npos) text += row + "\n";
  TextOut(path, files) << text;
}

void write_dataset(const Names& names, const RecordingMeta& meta, Files& files) {
  const Json description = {{"Name", "Recordings of the microsurgery trainer Filum"},
                            {"BIDSVersion", "1.9.0"},
                            {"DatasetType", "raw"},
                            {"License", "n/a"},
                            {"Authors", {"not given"}},
                            {"GeneratedBy", {{{"Name", "filum export"}, {"Version", meta.program}}}}};
  TextOut(names.root / "dataset_description.json", files) << description.dump(2) + "\n";
  TextOut(names.root / "README", files)
      << "Recordings of a microsurgery trainer. Tracking systems hand0, hand1, ... are the readings of the devices in the\n"
         "hand's space, nothing filled in; times in their LATENCY channel are those at which they arrived, by the clock of the\n"
         "computer that recorded, since the first of the tool: one clock for all devices that move it. scene0, scene1, ... are the poses commanded in the\n"
         "simulated scene after clutch and motion scaling. The origin of both is the middle of the field, x to the right, y\n"
         "away from the trainee, z up; rotations are right-handed quaternions. grip_force is in newton, raw_angle and raw_force are the converter's counts;\n"
         "flags is a bit set: 1 clutch, 2 cut, 4 next, 8 and 16 clamps off, 32 fresh suture, 256 angle saturated, 512 force saturated, 1024 and 2048 their wires broken, 4096 calibration of another handle.\n";
  add_rows(names.root / "participants.tsv", "participant_id\tcode", {names.subject + "\t" + (meta.participant.empty() ? "n/a" : meta.participant)}, files);
  TextOut(names.root / "participants.json", files)
      << Json({{"code", {{"Description", "Code of the participant in the trainer; never a name"}}}}).dump(2) + "\n";
}

}  // namespace

std::vector<std::string> export_bids(const RecordingReader& recording, const std::string& folder) {
  const RecordingMeta& meta = recording.meta();
  const Names names(meta, folder);
  Files files(names.root, names.motion);
  write_dataset(names, meta, files);
  for (int tool = 0; tool < 3; ++tool) write_hand(recording, names, tool, files);
  for (int tool = 0; tool < meta.n_tools; ++tool) write_scene(recording, names, tool, files);
  write_events(recording, names, files);
  std::vector<std::string> rows;
  for (const std::string& file : files.places()) {
    if (!file.ends_with("_motion.tsv")) continue;
    rows.push_back("motion/" + fs::path(file).filename().string() + "\t" + (meta.started_utc.empty() ? "n/a" : meta.started_utc));
  }
  if (!rows.empty()) add_rows(names.root / names.subject / names.session / (names.subject + "_" + names.session + "_scans.tsv"), "filename\tacq_time", rows, files);
  return files.put();
}

}  // namespace filum
