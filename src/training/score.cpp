#include "training/score.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string_view>
#include <vector>

#include "base/numbers.h"
#include "base/units.h"
#include "training/metrics.h"
#include "training/needle_watch.h"
#include "training/retraction.h"

namespace filum {
namespace {

constexpr double kGraspForce = 20e-3;  // [N], squeeze above which something is held

std::string number_text(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, std::abs(value) < 1000.0 ? "%.3g" : "%.0f", value);
  return buffer;
}

/// "12.5 mm"; "-" units are left out.
std::string shown(double si, const std::string& unit) {
  std::string text = number_text(si / unit_scale(unit));
  if (unit != "-") text.append(" ").append(unit);
  return text;
}

std::string band_text(const RubricItem& item) {
  const Band& b = item.band;
  const bool low = std::isfinite(b.full_from), high = std::isfinite(b.full_to);
  std::string text = "full points ";
  if (low && high) text += "from " + shown(b.full_from, item.unit) + " to " + shown(b.full_to, item.unit);
  if (low && !high) text += "from " + shown(b.full_from, item.unit);
  if (!low && high) text += "up to " + shown(b.full_to, item.unit);
  if (low && b.zero_below < b.full_from) text += (b.zero_below == 0.0 ? ", none at " : ", none below ") + shown(b.zero_below, item.unit);
  if (high && b.zero_above > b.full_to) text += ", none from " + shown(b.zero_above, item.unit);
  return text;
}

double value_of(Measure measure, const Result& r) {
  const Measures& m = r.measures;
  switch (measure) {
    case Measure::time:
      return m.seconds;
    case Measure::throws:
      return m.throws;
    case Measure::security:
      return r.security ? r.security->slip_force : kNaN;
    case Measure::path_length:
      return m.path_length;
    case Measure::movements:
      return m.movements;
    case Measure::idle_time:
      return m.idle_time;
    case Measure::sparc:
      return m.sparc;
    case Measure::ldlj:
      return m.ldlj;
    case Measure::grip_peak:
      return m.grip_peak;
    case Measure::drops:
      return m.drops;
    case Measure::thread_overload:
      return m.overload;
    case Measure::both_moving:
      return m.both_moving;
    case Measure::target_error:
      return m.target_error;
    case Measure::target_longest:
      return m.target_longest;
    case Measure::on_target:
      return m.on_target;
    case Measure::force_share:
      return m.force_share;
    case Measure::force_excess:
      return m.force_excess;
    case Measure::objects_broken:
      return m.objects_broken;
    case Measure::knot_class:
    case Measure::tail_lengths:
      return kNaN;
    default:
      if (r.needle) return needle_value(measure, *r.needle);
      return r.pressure ? retraction_value(measure, *r.pressure) : kNaN;
  }
  return kNaN;
}

/// What the value alone does not say.
std::string remark(Measure measure, const Result& r) {
  const Measures& m = r.measures;
  switch (measure) {
    case Measure::security:
      return r.security && r.security->held ? "held at the strongest pull; "
                                            : "slipped or broke at this pull; ";
    case Measure::sparc:
      return "median of " + std::to_string(m.sparc_segments) + " movements; ";
    case Measure::ldlj:
      return "median of " + std::to_string(m.ldlj_segments) + " movements; ";
    case Measure::grip_peak:
      return "largest of " + std::to_string(m.grasps) + " grasps, median " + shown(m.grip_median, "N") + "; ";
    case Measure::thread_overload:
      return "largest tension " + shown(m.tension_peak, "mN") + "; ";
    default:
      return {};
  }
}

const char* why_not_measured(Measure measure) {
  switch (measure) {
    case Measure::security:
      return "the knot was not pulled";
    case Measure::sparc:
      return "no movement between 0.3 s and 10 s long";
    case Measure::ldlj:
      return "no movement between 0.3 s and 10 s long that is clear of noise";
    case Measure::tail_lengths:
      return "the tails were not both cut, or there is no knot";
    default:
      return "nothing to measure";
  }
}

bool accepted(const Task& task, const std::string& knot_class) {
  return std::find(task.accept.begin(), task.accept.end(), knot_class) != task.accept.end();
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " or ") + word;
  return text;
}

void score_knot(const Task& task, const Result& r, ScoreItem& item) {
  item.text = r.knot.knot_class;
  const bool right = accepted(task, r.knot.knot_class);
  item.points = right && r.knot.encloses_post ? item.max_points : 0.0;
  item.why = "the thread's shape: ";
  item.why += r.knot.knot_class;
  if (!r.knot.composition.empty()) item.why += " (" + r.knot.composition + ")";
  item.why += right ? ", as asked" : ", asked for was " + joined(task.accept);
  if (right && !r.knot.encloses_post) item.why += ", but it does not enclose the post";
  item.why += "; decided by topology (Jones polynomial)";
}

void score_tails(const RubricItem& rule, const Result& r, ScoreItem& item) {
  const double shorter = r.measures.short_tail, longer = r.measures.long_tail;
  if (std::isnan(shorter) || std::isnan(longer)) {
    item.why = why_not_measured(Measure::tail_lengths);
    return;
  }
  const double share_short = rule.band.share(shorter), share_long = rule.band.share(longer);
  item.number = (share_short <= share_long ? shorter : longer) / unit_scale(rule.unit);
  item.points = item.max_points * std::min(share_short, share_long);
  item.why = "tails " + shown(shorter, rule.unit) + " and " + shown(longer, rule.unit) +
             ", the worse one counts; " + band_text(rule);
}

/// Whether a task that was not carried through earns points for it (score.h says the rule).
bool earned_unfinished(Measure measure) {
  switch (measure) {
    case Measure::throws:
    case Measure::knot_class:
    case Measure::security:
    case Measure::tail_lengths:
    case Measure::sparc:
    case Measure::ldlj:
    case Measure::force_excess:
    case Measure::needle_angle:
    case Measure::needle_share:
    case Measure::needle_present:
    case Measure::stitches:
    case Measure::bite_inequality:
    case Measure::bite_widest:
    case Measure::entry_error:
    case Measure::obliquity:
      return true;
    default:
      return false;
  }
}

ScoreItem score_item(const Task& task, const RubricItem& rule, const Result& r) {
  ScoreItem item;
  item.name = name_of(rule.measure);
  item.title = rule.title;
  item.unit = rule.unit;
  item.max_points = rule.points;
  if (rule.measure == Measure::knot_class) {
    score_knot(task, r, item);
  } else if (rule.measure == Measure::tail_lengths) {
    score_tails(rule, r, item);
  } else if (const double value = value_of(rule.measure, r); std::isnan(value)) {
    item.why = std::string("no points: ") + why_not_measured(rule.measure);
  } else {
    item.number = value / unit_scale(rule.unit);
    const bool counts = r.finished || earned_unfinished(rule.measure);
    item.points = counts ? rule.points * rule.band.share(value) : 0.0;
    item.why = counts ? "" : "no points, as not all steps were done; ";
    item.why += shown(value, rule.unit) + ": " + remark(rule.measure, r) + band_text(rule);
  }
  item.why += ". Source: " + rule.source;
  return item;
}

/// Critical lapses, and what the join had to be.
void judge_join(const NeedleTask& task, Result& r) {
  const auto fail = [&r](const std::string& reason) { r.verdict.push_back(reason); };
  for (const Lapse& l : r.needle->lapses)
    if (l.critical) fail((l.stitch < 0 ? std::string() : "stitch " + std::to_string(l.stitch + 1) + ": ") + l.name + ", a critical failure");
  const JoinGate& gate = task.join;
  if (gate.source.empty()) return;
  if (!r.needle->join || !r.needle->join->sound) return fail("the join could not be tested under pressure");
  const JoinReport& join = *r.needle->join;
  if (join.leak > gate.leak) fail("the join leaks " + shown(join.leak, "ml/min") + ", at most " + shown(gate.leak, "ml/min") + " is asked for");
  if (join.narrowing > gate.narrowing) fail("the lumen is narrowed by " + shown(100.0 * join.narrowing, "-") + " %, at most " + shown(100.0 * gate.narrowing, "-") + " % is asked for");
  if (gate.patent && !join.patent) fail("the join is not patent");
}

/// Stitches that are to end in a knot, and the classes that count.
struct AskedKnots {
  long stitches = 0;
  long tied_before = 0;  // of a running thread: by knots of their own that are not its last
  bool running = false;
  std::vector<std::string> classes;
};

/// A step that ties and cuts the last of several stitches names the ways up to it, so that its stitches are those of all steps before it as well.
AskedKnots asked_knots(const std::vector<NeedleGoal>& goals) {
  AskedKnots asked;
  for (const NeedleGoal& tie : goals) {
    asked.running = asked.running || tie.stitch.running;
    if (tie.kind != NeedleGoal::Kind::tie || tie.knots.empty()) continue;
    const bool is_cut = std::any_of(goals.begin(), goals.end(), [&](const NeedleGoal& g) { return g.kind == NeedleGoal::Kind::cut && g.passes == tie.passes; });
    long& stitches = is_cut ? asked.stitches : asked.tied_before;
    stitches = std::max(stitches, tie.passes / 2L);
    if (is_cut) asked.classes.insert(asked.classes.end(), tie.knots.begin(), tie.knots.end());
  }
  return asked;
}

/// Knots that were asked for, tied and cut, and do not hold any more at the end. A running thread's last one holds all of its stitches: more than were tied before it.
long opened(const NeedleTask& task, const NeedleReport& n) {
  const AskedKnots asked = asked_knots(task.goals);
  const auto holds = [&](const Stitch& s) { return std::find(asked.classes.begin(), asked.classes.end(), s.knot) != asked.classes.end(); };
  const long held = std::count_if(n.stitches.begin(), n.stitches.end(), holds);
  if (asked.running && asked.stitches > 0) return held > asked.tied_before ? 0 : 1;
  return std::max(0L, asked.stitches - held);
}

void judge(const Task& task, bool broken, Result& r) {
  const auto fail = [&r](const auto& reason) { r.verdict.emplace_back(reason); };
  if (task.demonstration_only) fail("a demonstration does not pass");
  if (!r.finished) fail("not all steps were done");
  if (broken) fail("the thread broke");
  if (r.needle && r.needle->out_of_turn > 0) fail(std::to_string(r.needle->out_of_turn) + " stitches were not made in their turn");
  if (r.needle && task.needle) judge_join(*task.needle, r);
  if (const long open = r.needle && task.needle && r.finished ? opened(*task.needle, *r.needle) : 0; open > 0)
    fail(std::to_string(open) + (open == 1 ? " knot that was tied does" : " knots that were tied do") + " not hold any more");
  if (task.has_knot() && !accepted(task, r.knot.knot_class))
    fail("the knot is a " + r.knot.knot_class + ", not a " + joined(task.accept));
  if (r.knot.knot_class != "unknot" && !r.knot.encloses_post) fail("the knot does not enclose the post");
  if (task.required_security > 0.0) {
    if (!r.security) {
      fail("the knot was not pulled");
    } else if (r.security->slip_force < task.required_security) {
      fail("the knot gave way at " + shown(r.security->slip_force, "mN") + ", asked for are " +
           shown(task.required_security, "mN"));
    }
  }
  if (r.total < task.pass_points) {
    fail(number_text(r.total) + " points, asked for are " + number_text(task.pass_points));
  }
  r.passed = r.verdict.empty();
  if (r.passed) r.verdict.emplace_back("all that was asked for was met (simulator-derived estimate)");
}

/// Every k-th index so that at most kMaxCurvePoints are left.
std::size_t stride_of(std::size_t n) {
  return std::max<std::size_t>(1, (n + kMaxCurvePoints - 1) / kMaxCurvePoints);
}

/// Thinned curve; each point is the largest of the samples it stands for, so that peaks stay.
Curve curve(const std::string& name, const std::string& title, const std::string& unit,
            const std::vector<double>& time, const std::vector<double>& value) {
  Curve c{name, title, unit, {}, {}};
  const std::size_t stride = stride_of(time.size()), n = std::min(time.size(), value.size());
  for (std::size_t k = 0; k < n; k += stride) {
    const auto begin = value.begin() + static_cast<std::ptrdiff_t>(k);
    const auto end = value.begin() + static_cast<std::ptrdiff_t>(std::min(n, k + stride));
    c.time.push_back(time[k]);
    c.value.push_back(*std::max_element(begin, end));
  }
  return c;
}

/// Paths, movements, rest and smoothness, over all instruments.
void measure_movement(const SeriesLog& log, Measures& m) {
  std::vector<double> sparcs, ldljs, fastest(log.size(), 0.0);
  for (int t = 0; t < log.n_tools(); ++t) {
    const Points path = log.tool(t).path();
    const std::vector<double> speed = speed_of(path, kMetricRate);
    for (std::size_t k = 0; k < speed.size(); ++k) fastest[k] = std::max(fastest[k], speed[k]);
    const std::vector<Segment> segments = movements(speed, kMetricRate);
    m.path_length += path_length(path);
    m.movements += static_cast<int>(segments.size());
    for (const Segment& segment : segments) {
      const Smoothness one = smoothness_of(speed, kMetricRate, {segment});
      if (one.sparc.n > 0) sparcs.push_back(one.sparc.median);
      if (one.ldlj.n > 0) ldljs.push_back(one.ldlj.median);
    }
  }
  m.sparc_segments = static_cast<int>(sparcs.size());
  m.ldlj_segments = static_cast<int>(ldljs.size());
  m.sparc = spread_of(sparcs).median;
  m.ldlj = spread_of(ldljs).median;
  m.idle_time = idle_time(fastest, kMetricRate);
}

void measure_grip(const SeriesLog& log, Measures& m) {
  std::vector<double> peaks;
  for (int t = 0; t < log.n_tools(); ++t) {
    const std::vector<double> grips = force_peaks(log.tool(t).grip, kGraspForce);
    peaks.insert(peaks.end(), grips.begin(), grips.end());
  }
  m.grasps = static_cast<int>(peaks.size());
  m.grip_median = peaks.empty() ? 0.0 : spread_of(peaks).median;
  m.grip_peak = peaks.empty() ? 0.0 : *std::max_element(peaks.begin(), peaks.end());
}

}  // namespace

Measures measure(const SeriesLog& log, const std::vector<TaskEvent>& events, double strength) {
  Measures m;
  measure_movement(log, m);
  measure_grip(log, m);
  for (const TaskEvent& e : events) m.drops += std::string_view(e.name) == "drop" || std::string_view(e.name) == "object-slipped" ? 1 : 0;
  for (double tension : log.tension()) m.tension_peak = std::max(m.tension_peak, tension);
  m.overload = strength > 0.0 ? m.tension_peak / strength : std::numeric_limits<double>::quiet_NaN();
  if (log.n_tools() >= 2) {
    const Bimanual both = bimanual(log.tool(0).path(), log.tool(1).path(), kMetricRate);
    m.both_moving = both.both_moving;
    m.speed_correlation = both.correlation;
    m.speed_lag = both.lag;
    m.dominance = both.dominance;
  }
  return m;
}

void score(const Task& task, bool broken, Result& result) {
  result.items.clear();
  result.verdict.clear();
  result.total = 0.0;
  result.max_total = task.max_total();
  for (const RubricItem& rule : task.rubric) {
    result.items.push_back(score_item(task, rule, result));
    result.total += result.items.back().points;
  }
  judge(task, broken, result);
}

void add_pressure_curves(Result& result) {
  const PressureReport& p = *result.pressure;
  const auto scaled = [](std::vector<double> values, double unit) {
    for (double& v : values) v /= unit;
    return values;
  };
  result.series.push_back(curve("pressure", "Largest pressure under the blades", "mmHg", p.time, scaled(p.pressure, kMmHg)));
  result.series.push_back(curve("dose", "Dose", "mmHg.min", p.time, scaled(p.dose_curve, 60.0 * kMmHg)));
  result.series.push_back(curve("exposed", "Share of the target seen", "-", p.time, p.exposed_curve));
}

void add_curves(const SeriesLog& log, const SceneDescription& scene, Result& result) {
  result.series.push_back(
      curve("thread_tension", "Largest tension of the thread", "N", log.time(), log.tension()));
  for (int t = 0; t < log.n_tools(); ++t) {
    const std::string& name = scene.tools[static_cast<std::size_t>(t)].name;
    const ToolLog& tool = log.tool(t);
    std::vector<double> speed = low_pass(speed_of(tool.path(), kMetricRate), kMetricRate, 6.0);
    for (double& v : speed) v = std::max(v, 0.0);  // the filter swings below
    result.series.push_back(curve("speed_" + name, "Speed of " + name, "m/s", log.time(), speed));
    result.series.push_back(curve("grip_force_" + name, "Squeeze of " + name, "N", log.time(), tool.grip));
    result.series.push_back(
        curve("thread_force_" + name, "Pull of the thread on " + name, "N", log.time(), tool.thread_force));
    ToolPath path{t, name, {}, {}};
    for (std::size_t k = 0; k < log.size(); k += stride_of(log.size())) {
      path.time.push_back(log.time()[k]);
      for (int axis = 0; axis < 3; ++axis) path.positions.push_back(tool.tip[k][axis]);
    }
    result.paths.push_back(std::move(path));
  }
}

}  // namespace filum
