#include "session/replay.h"

#include <vector>

#include "base/error.h"

namespace filum {
namespace {

/// Reads array hashes in step with the replay and finds the first array that differs at the steps where they
/// were taken.
class ArrayCheck {
 public:
  explicit ArrayCheck(const RecordingReader& recording) : cursor_(recording.array_hashes()) { advance(); }

  /// Name of the first array of `world` that differs at `step`; empty when none does; nothing when none was
  /// recorded there.
  std::optional<std::string> first_difference(std::uint64_t step, const World& world) {
    while (more_ && next_.step < step) advance();
    if (!more_ || next_.step != step) return std::nullopt;
    std::string differing;
    const auto hashes = world.array_hashes();
    for (; more_ && next_.step == step; advance()) {
      if (!differing.empty()) continue;
      bool same = false;
      for (const auto& [name, hash] : hashes)
        same = same || (name == next_.name.view() && hash == next_.hash);
      if (!same) differing = next_.name.view();
    }
    return differing;
  }

 private:
  void advance() { more_ = cursor_.next_readable(next_); }
  RecordCursor<ArrayHashRecord> cursor_;
  ArrayHashRecord next_;
  bool more_ = false;
};

/// False at the end or at damage, which the result then names.
bool next_step(RecordCursor<StepRecord>& steps, StepRecord& record, ReplayResult& result) {
  try {
    return steps.next(record);
  } catch (const InputError& error) {
    result.damage = error.value;
    return false;
  }
}

constexpr int kStepsToNameArray =
    1000;  // array hashes are taken every so many steps; beyond this there are none

}  // namespace

ReplayResult replay(const RecordingReader& recording, World& world,
                    const std::function<void(const StepRecord&, const Observation&)>& on_step,
                    bool to_the_end) {
  ReplayResult result;
  ArrayCheck arrays(recording);
  RecordCursor<StepRecord> steps = recording.steps();
  StepRecord record;
  bool array_named = false;
  std::uint64_t after_difference = 0;
  while (next_step(steps, record, result)) {
    world.step(record.inputs);
    const Observation& seen = world.observation();
    if (seen.step != record.step)
      throw InputError(recording.file(), "steps", "step " + std::to_string(record.step),
                       "step " + std::to_string(seen.step) + " (some were lost while recording)");
    const auto array = arrays.first_difference(record.step, world);
    if (!result.first_difference) {
      ++result.steps;
      if (seen.state_hash != record.state_hash) result.first_difference = {record.step, "state"};
    }
    if (on_step) on_step(record, seen);
    if (!result.first_difference) continue;
    if (!array_named && array && !array->empty()) {
      result.first_difference->array = *array;
      array_named = true;
    }
    if (!to_the_end && (array_named || ++after_difference > kStepsToNameArray)) break;
  }
  result.identical = !result.first_difference && result.damage.empty() && result.steps > 0;
  return result;
}

}  // namespace filum
