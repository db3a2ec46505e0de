// Recordings as tables: which columns there are, their units and their meaning.

#include <algorithm>
#include <cinttypes>
#include <cstdio>
#include <limits>
#include <map>

#include "session/table_builder.h"

#include "base/numbers.h"

namespace filum {
namespace {

std::string hex(std::uint64_t value) {
  char text[20];
  std::snprintf(text, sizeof text, "%016" PRIx64, value);
  return text;
}

Table inputs_table(const RecordingReader& recording) {
  const RecordingMeta& meta = recording.meta();
  TableBuilder table("inputs", step_rate(meta), "what each step of the simulation was driven by");
  RecordCursor<StepRecord> cursor = recording.steps();
  StepRecord record;
  while (cursor.next_readable(record)) {
    table.new_row();
    table.add_integer("step", "count", "step number", static_cast<std::int64_t>(record.step));
    table.add("time", "s", "scene time at the end of the step", static_cast<double>(record.step) * meta.dt);
    table.add_integer("host_time", "us", "steady clock of the host when the step began", record.host_time_us);
    table.add_integer("compute_time", "us", "how long the step took", record.compute_us);
    for (int i = 0; i < meta.n_tools; ++i) {
      const ToolInput& tool = record.inputs.tools[static_cast<std::size_t>(i)];
      const std::string prefix = "tool" + std::to_string(i) + "_";
      table.add_integer(prefix + "valid", "-", "1 while a live device moves the tool", tool.valid ? 1 : 0);
      table.add_vector(prefix + "p", "m", "commanded position of the jaw tip, world frame", tool.X_WD.p);
      table.add_quaternion(prefix + "q", "commanded orientation of the tool, world frame", tool.X_WD.q);
      table.add(prefix + "grip_angle", "rad", "commanded opening of the jaws", tool.grip_angle);
      table.add(prefix + "grip_force", "N", "measured squeeze; empty where not measured",
                tool.has_grip_force ? tool.grip_force : kNaN);
      table.add_integer(prefix + "buttons", "-", "bit set: 1 clutch, 2 cut, 4 next, 8 and 16 clamps off, 32 fresh suture", tool.buttons);
    }
    table.add_text("state_hash", "-", "XXH3-64 of the whole state after the step, hexadecimal",
                   hex(record.state_hash));
  }
  return table.take();
}

/// Mean rate [Hz] of each tool's readings, from the first to the last by the host's clock; 0 with fewer than two.
class SampleRates {
 public:
  explicit SampleRates(const RecordingReader& recording) {
    SampleRecord record;
    for (RecordCursor<SampleRecord> cursor = recording.samples(); cursor.next_readable(record);) {
      auto [tool, first] = tools_.try_emplace(record.tool, Tool{record.host_time_us, 0, 0});
      tool->second.last = record.host_time_us;
      if (!first) ++tool->second.after_the_first;
    }
  }
  double of(int tool) const {
    const auto at = tools_.find(tool);
    if (at == tools_.end() || at->second.last <= at->second.first) return 0.0;
    return 1e6 * static_cast<double>(at->second.after_the_first) / static_cast<double>(at->second.last - at->second.first);
  }
  /// That of all tools where they agree within 5 %, else 0.
  double common() const {
    double low = std::numeric_limits<double>::infinity(), high = 0.0;
    for (const auto& [tool, unused] : tools_) {
      low = std::min(low, of(tool));
      high = std::max(high, of(tool));
    }
    return high > 0.0 && high <= 1.05 * low ? 0.5 * (low + high) : 0.0;
  }

 private:
  struct Tool {
    std::int64_t first = 0, last = 0;  // [us]
    std::int64_t after_the_first = 0;
  };
  std::map<int, Tool> tools_;
};

Table samples_table(const RecordingReader& recording) {
  const SampleRates rates(recording);
  TableBuilder table("samples", rates.common(), "raw readings of the devices as they arrived, in the mean at the rate given for each tool; nothing is filled in");
  RecordCursor<SampleRecord> cursor = recording.samples();
  SampleRecord record;
  while (cursor.next_readable(record)) {
    table.new_row();
    const Vec3 p = record.has_pose ? record.X_WD.p : Vec3::Constant(kNaN);
    const Quat q = record.has_pose ? record.X_WD.q : Quat(kNaN, kNaN, kNaN, kNaN);
    table.add_integer("tool", "-", "index of the tool", record.tool);
    table.add_integer("host_time", "us", "steady clock of the host at arrival", record.host_time_us);
    table.add_integer("device_time", "us", "clock of the device, unwrapped", record.device_time_us);
    table.add_integer("sequence", "count", "sequence number; a gap is a loss", record.sequence);
    table.add_vector("p", "m", "position of the handle, world frame; empty where not measured", p);
    table.add_quaternion("q", "orientation of the handle, world frame; empty where not measured", q);
    table.add("grip_angle", "rad", "opening of the jaws; empty where not measured",
              record.has_grip_angle ? record.grip_angle : kNaN);
    table.add("grip_force", "N", "squeeze at the pads; empty where not measured",
              record.has_grip_force ? record.grip_force : kNaN);
    table.add("rate", "Hz", "mean rate of this tool's readings over the whole recording, by the host's clock", rates.of(record.tool));
    table.add_integer("raw_angle", "count", "converter's reading of the grip angle", record.raw_angle);
    table.add_integer("raw_force", "count", "converter's reading of the grip force", record.raw_force);
    table.add_integer("buttons", "-", "bit set: 1 clutch, 2 cut, 4 next, 8 and 16 clamps off, 32 fresh suture; 256 angle saturated, 512 force saturated, 1024 angle wire broken, 2048 force wire broken, 4096 calibration of another handle", record.buttons);
  }
  return table.take();
}

Table events_table(const RecordingReader& recording) {
  TableBuilder table("events", 0.0, "what happened, in the order it was noticed");
  RecordCursor<EventRecord> cursor = recording.events();
  EventRecord record;
  while (cursor.next_readable(record)) {
    table.new_row();
    table.add_integer("step", "count", "step number", static_cast<std::int64_t>(record.step));
    table.add("time", "s", "scene time", record.time);
    table.add_text("name", "-", "kind of event", std::string(record.name.view()));
    table.add_integer("tool", "-", "index of the tool, -1 none", record.tool);
    table.add("value", "see unit", "what the event measured", record.value);
    table.add_text("unit", "-", "unit of value", std::string(record.unit.view()));
    table.add_text("text", "-", "the same in words for people, such as a knot's class or a step's name; empty where there are none", std::string(record.text.view()));
  }
  return table.take();
}

Table array_hashes_table(const RecordingReader& recording) {
  TableBuilder table("array_hashes", 0.0, "hash of each array of the state, taken every so many steps");
  RecordCursor<ArrayHashRecord> cursor = recording.array_hashes();
  ArrayHashRecord record;
  while (cursor.next_readable(record)) {
    table.new_row();
    table.add_integer("step", "count", "step number", static_cast<std::int64_t>(record.step));
    table.add_text("array", "-", "name of the array", std::string(record.name.view()));
    table.add_text("hash", "-", "XXH3-64, hexadecimal", hex(record.hash));
  }
  return table.take();
}

Table score_table(const RecordingReader& recording) {
  TableBuilder table("score", 0.0, "result of the task as it was given at the time");
  if (const auto& score = recording.score()) {
    table.new_row();
    table.add_integer("passed", "-", "1 if the task was passed", score->passed ? 1 : 0);
    table.add("total", "points", "sum of the points", score->total);
    table.add("seconds", "s", "scene time of the task", score->seconds);
    table.add_text("json", "-", "every item with value, unit, points and reason, as JSON", score->json);
  }
  return table.take();
}

}  // namespace

std::vector<Table> recorded_tables(const RecordingReader& recording) {
  return {inputs_table(recording), samples_table(recording), events_table(recording),
          array_hashes_table(recording), score_table(recording)};
}

}  // namespace filum
