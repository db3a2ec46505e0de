#include <limits>

#include "training/retraction_task.h"

namespace filum {

RetractionGoal parse_goal(const YamlNode& node) {
  RetractionGoal g;
  const std::string kind = node.choice("kind", {"press", "release", "expose", "hold"});
  g.seconds = node.quantity("for", "s", Range::between(0.0, 7200.0));
  const Range any = Range::not_negative();
  g.blind = node.flag_or("blind", false);
  if (kind == "press") {
    g.kind = RetractionGoal::Kind::press;
    g.low = node.quantity("from", "mmHg", any);
    g.high = node.quantity("to", "mmHg", {g.low, std::numeric_limits<double>::infinity(), true});
  } else if (kind == "release") {
    g.kind = RetractionGoal::Kind::release;
    g.high = node.quantity("below", "mmHg", Range::positive());
  } else {
    g.kind = kind == "expose" ? RetractionGoal::Kind::expose : RetractionGoal::Kind::hold;
    g.share = node.number_or("share", 0.0, Range::between(0.0, 1.0));
    if (kind == "hold") g.low = node.quantity_or("from", "mmHg", 0.0, any);
    g.high = node.quantity_or("below", "mmHg", std::numeric_limits<double>::infinity(), Range::positive());
    g.on_arm = node.flag_or("on_arm", false);
    if (g.share <= 0.0 && g.low <= 0.0) node.refuse("share", "a share of the target above 0" + std::string(kind == "hold" ? ", or a pressure `from`" : ""));
  }
  return g;
}

}  // namespace filum
