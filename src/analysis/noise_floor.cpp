#include "analysis/noise_floor.h"

namespace filum {
namespace {

const ToolSeries* tool_of(const RecordedSession& session, int tool) {
  for (const ToolSeries& t : session.tools)
    if (t.tool == tool) return &t;
  return nullptr;
}

}  // namespace

NoiseFloor noise_floor(const RecordedSession& session, const RecordedSession* clamped, int tool, bool hand, const EvenPath& path) {
  if (clamped) {
    const ToolSeries* still = tool_of(*clamped, tool);
    if (!still) return {std::nullopt, "the clamped recording does not hold this tool"};
    return {(hand ? still->hand : still->scene).even(), "clamped tool: " + clamped->file};
  }
  if (!session.meta.input.starts_with("demonstrat")) return {std::nullopt, "not measured"};
  EvenPath zero = path;
  for (Points& p : zero.stretches) p.setZero();
  return {zero, "zero: a script has no sensor"};
}

const RecordedSession* clamped_like(const RecordedSession& session, const std::vector<RecordedSession>& clamped) {
  for (const RecordedSession& still : clamped)
    if (still.meta.input == session.meta.input) return &still;
  return nullptr;
}

}  // namespace filum
