#include "cli/security.h"

#include "world/pull_test.h"

namespace filum {

bool has_knot_to_pull(const TaskSession& task, const World& world, const Result& result) {
  return task.task().has_knot() && result.finished && result.knot.knot_class != "unknot" && world.description().has_post;
}

Result finish_with_security(const TaskSession& task, const World& world, const std::function<bool(double)>& go_on) {
  Result result = task.finish();
  if (!has_knot_to_pull(task, world, result)) return result;
  PullTestOptions options;
  options.go_on = go_on;
  const PullTestReport pulled = pull_test(world.model(), world.state(), options);
  if (pulled.abandoned) return result;
  return task.finish(SecurityTest{pulled.held, pulled.force, pulled.most_pull, pulled.opening});
}

}  // namespace filum
