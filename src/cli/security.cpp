#include "cli/security.h"

#include "world/join_test.h"
#include "world/pull_test.h"
#include "world/vessel_model.h"

namespace filum {
namespace {

JoinReport tested_join(const World& world) {
  JoinTestOptions options;
  options.pressure = world.model().vessel->circulation.pressure;
  const JoinTestReport t = join_test(world.model(), world.state(), options);
  JoinReport r;
  r.pressure = options.pressure;
  r.leak = t.leak;
  r.area = t.area;
  r.sector_flow.assign(t.flow.begin(), t.flow.end());
  r.sector_gap.assign(t.gap.begin(), t.gap.end());
  for (const EdgeGap& g : t.edge) r.edge.push_back({g.share, g.gap});
  r.narrowing = t.narrowing;
  r.through = t.through;
  r.patent = t.patent;
  r.thread_inside = t.thread_inside;
  r.overlap = t.overlap / world.description().tissue.thickness;
  r.sound = t.sound;
  return r;
}

}  // namespace

bool has_knot_to_pull(const TaskSession& task, const World& world, const Result& result) {
  return task.task().has_knot() && result.finished && result.knot.knot_class != "unknot" && world.description().has_post;
}

Result finish_with_security(const TaskSession& task, const World& world, const std::function<bool(double)>& go_on) {
  if (world.description().tissue.lumen && task.task().needle != nullptr) return task.finish(std::nullopt, tested_join(world));
  Result result = task.finish();
  if (!has_knot_to_pull(task, world, result)) return result;
  PullTestOptions options;
  options.go_on = go_on;
  const PullTestReport pulled = pull_test(world.model(), world.state(), options);
  if (pulled.abandoned) return result;
  return task.finish(SecurityTest{pulled.held, pulled.force, pulled.most_pull, pulled.opening});
}

}  // namespace filum
