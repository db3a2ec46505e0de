#include "cli/security.h"

#include "world/pull_test.h"

namespace filum {

Result finish_with_security(const TaskSession& task, const World& world) {
  Result result = task.finish();
  const bool knotted = task.task().has_knot() && result.finished && result.knot.knot_class != "unknot";
  if (!knotted || !world.description().has_post) return result;
  const PullTestReport pulled = pull_test(world.model(), world.state());
  return task.finish(SecurityTest{pulled.held, pulled.force, pulled.most_pull, pulled.opening});
}

}  // namespace filum
