// What the simulation answered to a recording, by stepping it again.

#include <algorithm>

#include "session/replay.h"
#include "session/table_builder.h"

namespace filum {
namespace {

double largest_tension(const Observation& seen) {
  double largest = 0.0;
  for (int i = 0; i + 1 < seen.n_nodes; ++i)
    largest = std::max(largest, seen.tension[static_cast<std::size_t>(i)]);
  return largest;
}

void add_simulated_row(TableBuilder& table, const Observation& seen) {
  table.new_row();
  table.add_integer("step", "count", "step number", static_cast<std::int64_t>(seen.step));
  table.add("time", "s", "scene time", seen.time);
  for (int i = 0; i < seen.n_tools; ++i) {
    const ToolObservation& tool = seen.tools[static_cast<std::size_t>(i)];
    const std::string prefix = "tool" + std::to_string(i) + "_";
    table.add_vector(prefix + "p", "m", "simulated position of the jaw tip, world frame", tool.X_WT.p);
    table.add_quaternion(prefix + "q", "simulated orientation, world frame", tool.X_WT.q);
    table.add_vector(prefix + "v", "m/s", "velocity of the jaw tip, world frame", tool.v_W);
    table.add_vector(prefix + "f", "N", "force of the scene on the tool, world frame", tool.f_T_W);
    table.add(prefix + "grip_angle", "rad", "simulated opening of the jaws", tool.grip_angle);
    table.add(prefix + "grip_force", "N", "squeeze at the pads", tool.grip_force);
    table.add(prefix + "thread_force", "N", "pull of the thread on the jaws", tool.thread_force);
    table.add_integer(prefix + "grasped_edge", "-", "edge of the thread in the jaws, -1 none; of a spatula, which of its shapes",
                      tool.grasped_edge);
  }
  table.add("thread_tension_max", "N", "largest tension along the thread", largest_tension(seen));
  table.add_integer("contacts", "count", "places where the thread touches itself", seen.n_contacts);
  table.add("min_gap", "m", "smallest distance between surfaces of strands", seen.min_gap);
}

}  // namespace

Table simulated_table(const RecordingReader& recording, World& world) {
  TableBuilder table("simulated", step_rate(recording.meta()),
                     "what the simulation answered, from stepping it again through the inputs");
  replay(
      recording, world, [&](const StepRecord&, const Observation& seen) { add_simulated_row(table, seen); },
      true);
  return table.take();
}

}  // namespace filum
