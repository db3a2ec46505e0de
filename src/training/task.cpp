#include "training/task.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>

#include "base/error.h"
#include "base/units.h"
#include "training/needle_task.h"
#include "training/rating_scale.h"
#include "training/retraction.h"

namespace filum {
namespace {

struct MeasureName {
  Measure measure;
  const char* name;
  const char* unit;
};

constexpr std::array kMeasureNames = {
    MeasureName{Measure::time, "time", "s"},
    MeasureName{Measure::throws, "throws", "-"},
    MeasureName{Measure::knot_class, "knot-class", "-"},
    MeasureName{Measure::security, "security", "N"},
    MeasureName{Measure::tail_lengths, "tail-lengths", "m"},
    MeasureName{Measure::path_length, "path-length", "m"},
    MeasureName{Measure::movements, "movements", "-"},
    MeasureName{Measure::idle_time, "idle-time", "s"},
    MeasureName{Measure::sparc, "sparc", "-"},
    MeasureName{Measure::ldlj, "ldlj", "-"},
    MeasureName{Measure::grip_peak, "grip-peak", "N"},
    MeasureName{Measure::drops, "drops", "-"},
    MeasureName{Measure::thread_overload, "thread-overload", "-"},
    MeasureName{Measure::both_moving, "both-moving", "-"},
    MeasureName{Measure::target_error, "target-error", "m"},
    MeasureName{Measure::target_longest, "target-longest", "m"},
    MeasureName{Measure::on_target, "on-target", "-"},
    MeasureName{Measure::force_share, "force-share", "-"},
    MeasureName{Measure::force_excess, "force-excess", "N"},
    MeasureName{Measure::objects_broken, "objects-broken", "-"},
    MeasureName{Measure::pressure_peak, "pressure-peak", "Pa"},
    MeasureName{Measure::pressure_tip, "pressure-tip", "Pa"},
    MeasureName{Measure::pressure_dose, "pressure-dose", "Pa.s"},
    MeasureName{Measure::time_in_red, "time-in-red", "s"},
    MeasureName{Measure::time_over, "time-over-bands", "s"},
    MeasureName{Measure::hold_peak, "hold-peak", "Pa"},
    MeasureName{Measure::releases, "releases", "-"},
    MeasureName{Measure::press_error, "press-error", "Pa"},
    MeasureName{Measure::loaded_longest, "loaded-longest", "s"},
    MeasureName{Measure::exposed, "exposed", "-"},
    MeasureName{Measure::slips, "slips", "-"},
    MeasureName{Measure::edge_cuts, "edge-cuts", "-"},
    MeasureName{Measure::veins_torn, "veins-torn", "-"},
    MeasureName{Measure::needle_angle, "needle-angle", "rad"},
    MeasureName{Measure::needle_share, "needle-share", "-"},
    MeasureName{Measure::needle_takes, "needle-takes", "-"},
    MeasureName{Measure::needle_drops, "needle-drops", "-"},
    MeasureName{Measure::needle_present, "needle-present", "m"},
    MeasureName{Measure::tissue_takes, "tissue-takes", "-"},
    MeasureName{Measure::wall_grasps, "wall-grasps", "-"},
    MeasureName{Measure::tissue_slips, "tissue-slips", "-"},
    MeasureName{Measure::grip_pull, "grip-pull", "N"},
    MeasureName{Measure::stitch_order, "stitch-order", "-"},
    MeasureName{Measure::stitches, "stitches", "-"},
    MeasureName{Measure::bite_inequality, "bite-inequality", "-"},
    MeasureName{Measure::bite_widest, "bite-widest", "-"},
    MeasureName{Measure::entry_error, "entry-error", "rad"},
    MeasureName{Measure::obliquity, "obliquity", "rad"},
    MeasureName{Measure::tissue_pull, "tissue-pull", "N"},
    MeasureName{Measure::lapses, "lapses", "-"},
};

const MeasureName& entry_of(Measure measure) {
  return *std::find_if(kMeasureNames.begin(), kMeasureNames.end(),
                       [&](const MeasureName& m) { return m.measure == measure; });
}

const std::vector<std::string> kClasses = {"square",   "granny",       "surgeons", "triple",
                                           "overhand", "half-hitches", "unknot",   "other"};

StepKind step_kind(const std::string& word) {
  if (word == "loop") return StepKind::loop;
  if (word == "pass") return StepKind::pass;
  if (word == "lay") return StepKind::lay;
  if (word == "tighten") return StepKind::tighten;
  return StepKind::cut;
}

TaskStep parse_step(const YamlNode& node, int throws) {
  TaskStep step;
  step.kind = step_kind(node.choice("kind", {"loop", "pass", "lay", "tighten", "cut"}));
  step.throw_number = step.kind == StepKind::cut ? 0 : node.integer("throw", 1, throws);
  step.name = node.text("name");
  step.hint = node.text("hint");
  return step;
}

/// "[x, y, z]" points, at least two, none twice in a row.
Points parse_path(const YamlNode& node) {
  std::vector<Vec3> points;
  for (const YamlNode& point : node.items("path")) points.push_back(point.vec3("p", "mm"));
  if (points.size() < 2) node.refuse("path", "at least two points");
  Points path(3, static_cast<Eigen::Index>(points.size()));
  for (std::size_t k = 0; k < points.size(); ++k) {
    path.col(static_cast<Eigen::Index>(k)) = points[k];
    if (k > 0 && (points[k] - points[k - 1]).norm() < 1e-6) node.refuse("path", "no point twice in a row");
  }
  return path;
}

TaskStep parse_lab_step(const YamlNode& node) {
  TaskStep step;
  const std::string kind = node.choice("kind", {"hold", "follow", "place"});
  step.throw_number = 0;
  step.name = node.text("name");
  step.hint = node.text("hint");
  step.within = node.quantity("within", "mm", {1e-6, 0.1, false});
  if (kind == "follow") {
    step.kind = StepKind::follow;
    step.path = parse_path(node);
    return step;
  }
  step.at = node.vec3("at", "mm");
  step.kind = kind == "hold" ? StepKind::hold : StepKind::place;
  if (step.kind == StepKind::hold) step.seconds = node.quantity("seconds", "s", Range::between(1.0, 600.0));
  if (step.kind == StepKind::place) step.object = node.integer("object", 0, 7);
  return step;
}

/// Goals of brain retraction, and the steps that show them.
void parse_retraction(const YamlNode& file, const std::string& root, Task& task) {
  auto retraction = std::make_shared<RetractionTask>();
  retraction->limits = load_pressure_limits(root + "/" + file.text("limits"));
  for (const YamlNode& node : file.items("steps")) {
    TaskStep step;
    step.throw_number = 0;
    step.name = node.text("name");
    step.hint = node.text("hint");
    task.steps.push_back(step);
    retraction->goals.push_back(parse_goal(node));
  }
  task.throws = 0;
  task.retraction = std::move(retraction);
}

/// The scales that raters mark a task by: a list, or the one `scale` of recordings made before there were several.
std::vector<std::shared_ptr<const RatingScale>> parse_scales(const YamlNode& file, const std::string& root) {
  if (file.has("scale") && file.has("scales")) file.refuse("scale", "scales alone");
  std::vector<std::string> paths;
  if (file.has("scale")) paths = {file.text("scale")};
  if (file.has("scales")) paths = file.texts("scales");
  if (file.has("scales") && paths.empty()) file.refuse("scales", "at least one file of a rating scale");
  std::vector<std::shared_ptr<const RatingScale>> scales;
  for (const std::string& path : paths) {
    scales.push_back(std::make_shared<const RatingScale>(load_rating_scale(root + "/" + path)));
    const auto same = [&](const auto& other) { return other->name == scales.back()->name; };
    if (std::count_if(scales.begin(), scales.end(), same) > 1) file.refuse("scales", "each scale once");
  }
  return scales;
}

/// Goals with a needle, and the steps that show them.
void parse_needle(const YamlNode& file, const std::string& root, Task& task) {
  auto needle = std::make_shared<NeedleTask>();
  needle->has_tissue = file.has("lapses");
  if (needle->has_tissue) needle->lapses = load_lapse_rules(root + "/" + file.text("lapses"));
  if (needle->has_tissue) needle->scales = parse_scales(file, root);
  if (file.has("join")) needle->join = parse_join_gate(file.map("join"));
  for (const YamlNode& node : file.items("steps")) {
    TaskStep step;
    step.throw_number = 0;
    step.name = node.text("name");
    step.hint = node.text("hint");
    needle->goals.push_back(parse_needle_goal(node));
    const NeedleGoal& goal = needle->goals.back();
    if (goal.kind == NeedleGoal::Kind::present) {
      step.kind = StepKind::hold;  // shown as a target
      step.at = goal.at;
      step.within = goal.within;
    }
    task.steps.push_back(step);
  }
  task.throws = 0;
  task.needle = std::move(needle);
}

Measure parse_measure(const YamlNode& node) {
  std::vector<std::string> names;
  for (const MeasureName& m : kMeasureNames) names.push_back(m.name);
  const std::string word = node.choice("measure", names);
  return std::find_if(kMeasureNames.begin(), kMeasureNames.end(),
                      [&](const MeasureName& m) { return word == m.name; })
      ->measure;
}

Band parse_band(const YamlNode& node, const std::string& unit) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Band band{-kInfinity, -kInfinity, kInfinity, kInfinity};
  if (node.has("full_from")) {
    band.full_from = node.quantity("full_from", unit);
    band.zero_below = node.quantity_or("zero_below", unit, band.full_from);
  }
  if (node.has("full_to")) {
    band.full_to = node.quantity("full_to", unit);
    band.zero_above = node.quantity_or("zero_above", unit, band.full_to);
  }
  if (!node.has("full_from") && !node.has("full_to")) node.refuse("full_to", "full_from or full_to, or both");
  if (band.zero_below > band.full_from) node.refuse("zero_below", "at most full_from");
  if (band.full_from > band.full_to) node.refuse("full_from", "at most full_to");
  if (band.full_to > band.zero_above) node.refuse("zero_above", "at least full_to");
  return band;
}

RubricItem parse_item(const YamlNode& node) {
  RubricItem item;
  item.measure = parse_measure(node);
  item.title = node.text("title");
  item.points = node.number("points", Range::positive());
  item.source = node.text("source");
  item.unit = unit_of(item.measure);
  if (item.measure == Measure::knot_class) return item;
  if (node.has("unit")) {
    item.unit = node.text("unit");
    bool same = false;
    try {
      same = dimension_of(item.unit) == dimension_of(unit_of(item.measure));
    } catch (const InputError&) {
      same = false;  // refused below, with the file's name
    }
    if (!same) node.refuse("unit", std::string("a unit like ") + unit_of(item.measure));
  }
  item.band = parse_band(node, item.unit);
  return item;
}

Recognition parse_recognition(const YamlNode& node) {
  Recognition r;
  r.loop_turns = node.number_or("loop_turns", r.loop_turns, Range::between(0.25, 3.0));
  r.tight_tension = node.quantity_or("tight_tension", "N", r.tight_tension, Range::positive());
  r.tight_turns = node.number_or("tight_turns", r.tight_turns, Range::between(1.0, 20.0));
  r.overload = node.number_or("overload", r.overload, Range::between(0.05, 1.0));
  r.grip_limit = node.quantity_or("grip_limit", "N", r.grip_limit, Range::positive());
  return r;
}

std::vector<std::string> parse_accept(const YamlNode& file) {
  const std::vector<std::string> classes = file.texts("accept");
  for (const std::string& word : classes) {
    if (std::find(kClasses.begin(), kClasses.end(), word) == kClasses.end()) {
      file.refuse("accept",
                  "a list of knot classes: square, granny, surgeons, triple, overhand, half-hitches");
    }
  }
  if (classes.empty()) file.refuse("accept", "at least one knot class");
  return classes;
}

}  // namespace

const char* name_of(Measure measure) {
  return entry_of(measure).name;
}
const char* unit_of(Measure measure) {
  return entry_of(measure).unit;
}

double Band::share(double value) const {
  if (std::isnan(value)) return 0.0;
  if (value < full_from) return value <= zero_below ? 0.0 : (value - zero_below) / (full_from - zero_below);
  if (value > full_to) return value >= zero_above ? 0.0 : (zero_above - value) / (zero_above - full_to);
  return 1.0;
}

double Task::max_total() const {
  double sum = 0.0;
  for (const RubricItem& item : rubric) sum += item.points;
  return sum;
}

Task parse_task(const YamlNode& file, const std::string& root) {
  file.choice("format", {"filum-task/1"});
  Task task;
  task.name = file.text("name");
  task.title = file.text("title");
  task.description = file.text("description");
  task.suture = file.text("suture");
  task.demonstration_only = file.flag_or("demonstration_only", false);
  task.time_limit = file.quantity("time_limit", "s", Range::between(1.0, 3600.0));
  const std::string kind = file.has("kind") ? file.choice("kind", {"knot", "laboratory", "retraction", "needle"}) : "knot";
  task.laboratory = kind == "laboratory";
  if (task.laboratory) {
    task.lab_tool = file.integer("tool", 0, 2);
    task.throws = 0;
  } else if (kind == "retraction") {
    parse_retraction(file, root, task);
  } else if (kind == "needle") {
    parse_needle(file, root, task);
  } else {
    task.accept = parse_accept(file);
    task.throws = file.integer("throws", 1, 4);
  }
  task.required_security = file.quantity_or("required_security", "N", 0.0, Range::not_negative());
  if (file.has("recognition")) task.recognition = parse_recognition(file.map("recognition"));
  for (const YamlNode& node : kind == "retraction" || kind == "needle" ? std::vector<YamlNode>() : file.items("steps"))
    task.steps.push_back(task.laboratory ? parse_lab_step(node) : parse_step(node, task.throws));
  for (const YamlNode& node : file.items("rubric")) task.rubric.push_back(parse_item(node));
  if (task.steps.empty()) file.refuse("steps", "at least one step");
  if (task.rubric.empty()) file.refuse("rubric", "at least one line");
  task.pass_points = file.number("pass_points", Range::between(0.0, task.max_total()));
  file.finish();
  return task;
}

Task load_task(const std::string& path) {
  return parse_task(YamlNode::load(path), std::filesystem::path(path).parent_path().parent_path().parent_path().string());
}

}  // namespace filum
