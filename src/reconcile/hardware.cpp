#include "reconcile/hardware.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/error.h"
#include "base/units.h"
#include "reconcile/model.h"
#include "reconcile/estimate.h"

namespace filum::reconcile {
namespace {

template <class... A>
std::string text(const char* format, A... values) {
  char out[200];
  std::snprintf(out, sizeof out, format, values...);
  return out;
}

void check_clock(const Trial& t, std::vector<HardwareCheck>& out) {
  if (!t.clocked || t.samples() < 8) return;
  std::vector<double> steps;
  Eigen::Index longest = 1;
  for (Eigen::Index n = 1; n < t.time.size(); ++n) {
    steps.push_back(t.time[n] - t.time[n - 1]);
    if (steps.back() > t.time[longest] - t.time[longest - 1]) longest = n;
  }
  const double usual = median(steps), most = t.time[longest] - t.time[longest - 1];
  if (most > 5.0 * usual) out.push_back({"gap", t.file, text("no sample for %.3g s from %.4g s on, where %.3g s are usual", most, t.time[longest - 1], usual)});
  std::vector<double> away;
  for (const double s : steps) away.push_back(std::abs(s - usual));
  const double jitter = 1.48 * median(away) / usual;
  if (jitter > 0.02) out.push_back({"clock", t.file, text("steps of the clock vary by %.2g %% of their %.3g s", 100.0 * jitter, usual)});
}

void check_values(const Trial& t, const Channel& c, std::vector<HardwareCheck>& out) {
  std::vector<double> values, sorted;
  for (const double v : t.at(c.name))
    if (std::isfinite(v)) values.push_back(v);
  if (values.size() < 20) return;
  sorted = values;
  std::sort(sorted.begin(), sorted.end());
  const double range = sorted.back() - sorted.front();
  if (range <= 0.0) return;
  // the step of a converter: the least distance of neighbours, if all distances are multiples of it
  std::vector<double> gaps;
  for (std::size_t i = 1; i < sorted.size(); ++i)
    if (sorted[i] - sorted[i - 1] > 1e-9 * range) gaps.push_back(sorted[i] - sorted[i - 1]);
  const double step = *std::min_element(gaps.begin(), gaps.end());
  const auto whole = std::count_if(gaps.begin(), gaps.end(), [&](double g) { return std::abs(g / step - std::round(g / step)) < 0.05; });
  const std::string where = t.file + " " + c.name;
  if (step > 2e-5 * range && static_cast<std::size_t>(whole) > gaps.size() * 95 / 100)
    out.push_back({"quantisation", where, text("values in steps of %.3g %s: %.1f bits over what was measured", step / c.scale, c.unit.c_str(), std::log2(range / step))});
  std::vector<double> moves;
  for (std::size_t i = 1; i < values.size(); ++i) moves.push_back(std::abs(values[i] - values[i - 1]));
  std::size_t run = 0, longest = 0;
  for (const double m : moves) longest = std::max(longest, run = m == 0.0 ? run + 1 : 0);
  const bool at_top = std::count(values.begin(), values.end(), sorted.back()) > 5 || std::count(values.begin(), values.end(), sorted.front()) > 5;
  if (median(moves) > 0.0 && longest > 8 && !at_top) out.push_back({"frozen", where, text("%zu samples in a row are equal while the signal moves elsewhere", longest + 1)});
  const auto shared = [&](double v, double next) {
    const auto n = std::count(values.begin(), values.end(), v), m = std::count(values.begin(), values.end(), next);
    return n >= 6 && static_cast<double>(n) > 0.01 * static_cast<double>(values.size()) && n > 4 * std::max<std::ptrdiff_t>(1, m);
  };
  const auto below = std::lower_bound(sorted.begin(), sorted.end(), sorted.back()), above = std::upper_bound(sorted.begin(), sorted.end(), sorted.front());
  if (below != sorted.begin() && shared(sorted.back(), *std::prev(below))) out.push_back({"saturation", where, text("the largest value, %.4g %s, is shared by many samples", sorted.back() / c.scale, c.unit.c_str())});
  if (above != sorted.end() && shared(sorted.front(), *above) && sorted.front() != 0.0) out.push_back({"saturation", where, text("the least value, %.4g %s, is shared by many samples", sorted.front() / c.scale, c.unit.c_str())});
}

}  // namespace

std::vector<HardwareCheck> check_hardware(const Dataset& d) {
  std::vector<HardwareCheck> out;
  for (const Trial& t : d.trials) {
    check_clock(t, out);
    for (const std::string& name : d.outputs) check_values(t, d.channel(name), out);
  }
  return out;
}

namespace {

/// The record's own speed [input/s] against the rate that its protocol states: a slip in the unit of time shows nowhere else.
void check_rate(const Dataset& d, const Trial& t, std::vector<HardwareCheck>& out) {
  const char* input = d.rig == Rig::tissue_block ? "displacement" : d.rig == Rig::spatula_press ? "depth" : d.rig == Rig::vessel_inflation ? "pressure" : nullptr;
  if (input == nullptr || !t.has(input) || !t.clocked || t.word("rate").empty()) return;
  const char* unit = d.rig == Rig::vessel_inflation ? "Pa/s" : "m/s";
  double stated = 0.0;
  try {
    stated = std::abs(parse_quantity(t.word("rate"), unit));
  } catch (const InputError&) {
    return;  // free text: a strain rate, a word
  }
  const Eigen::VectorXd& u = t.at(input);
  const Eigen::Index w = std::max<Eigen::Index>(1, u.size() / 50);
  double fastest = 0.0;
  for (Eigen::Index n = 0; n + w < u.size(); ++n)
    if (const double v = std::abs(u[n + w] - u[n]) / (t.time[n + w] - t.time[n]); std::isfinite(v)) fastest = std::max(fastest, v);
  constexpr double kWrong = 50.0;
  if (stated > 0.0 && (fastest > kWrong * stated || fastest < stated / kWrong))
    out.push_back({"unit", t.file + ", rate", text("%s moves at %.3g %s at most, its protocol says %s: is the unit of time, or of the input, wrong by 1000?", input, fastest, unit, t.word("rate").c_str())});
}

/// Where a protocol says how long it holds, or the samples say how fast they move, the clock can be held against it; a still hand's clock against
/// what a hand can be seen by.
void check_clock_unit(const Dataset& d, const Trial& t, std::vector<HardwareCheck>& out) {
  if (!t.clocked || t.samples() < 3) return;
  const double span = t.time[t.samples() - 1] - t.time[0], rate = (t.samples() - 1) / span;
  double hold = 0.0;
  try {
    if (!t.word("hold").empty()) hold = parse_quantity(t.word("hold"), "s");
  } catch (const InputError&) {  // no time: refused where it was read
  }
  if (hold > 0.0 && (span < 0.5 * hold || span > 300.0 * hold))
    out.push_back({"unit", t.file + ", hold", text("the record lasts %.3g s, its protocol holds for %s: is the unit of time wrong by 1000?", span, t.word("hold").c_str())});
  // where nothing states a speed: a pull and a grip are over in seconds, a creeping thread may take a day
  const bool quick = d.rig == Rig::suture_pull || d.rig == Rig::forceps_bridge, hangs = d.rig == Rig::suture_cantilever && hold <= 0.0;
  if ((quick && (span < 0.1 || span > 5000.0)) || (hangs && span < 1.0))
    out.push_back({"unit", t.file + ", time", text("the record lasts %.3g s: is the unit of time wrong by 1000?", span)});
  if (d.rig == Rig::tip_hold && (rate < 4.0 || rate > 4000.0))
    out.push_back({"unit", t.file + ", time", text("%.3g samples a second, expected 4 to 4000: is the unit of time wrong by 1000?", rate)});
  if (d.rig != Rig::needle_insertion || !t.has("speed") || !t.has("depth")) return;
  const Eigen::VectorXd &u = t.at("depth"), &v = t.at("speed");
  double moved = 0.0, stated = 0.0;
  for (Eigen::Index n = 0; n + 1 < u.size(); ++n)
    if (std::isfinite(u[n]) && std::isfinite(u[n + 1]) && std::isfinite(v[n])) moved += std::abs(u[n + 1] - u[n]), stated += std::abs(v[n]) * (t.time[n + 1] - t.time[n]);
  if (stated > 0.0 && moved > 0.0 && (moved > 50.0 * stated || stated > 50.0 * moved))
    out.push_back({"unit", t.file + ", depth", text("the needle travels %.3g m where its speed makes it %.3g m: is the unit of time, depth or speed wrong by 1000?", moved, stated)});
}

}  // namespace

std::vector<HardwareCheck> check_units(const Dataset& d, const std::vector<Estimate>& baseline) {
  std::vector<HardwareCheck> out;
  for (const Estimate& e : baseline) {
    const auto own = d.nominal.find(e.name);
    if (own == d.nominal.end() || own->second == 0.0 || e.name == "poissons_ratio" || e.name.ends_with("offset")) continue;
    const double times = std::abs(e.value / own->second), most = e.name == "friction_coefficient" ? 8.0 : 100.0;
    if (times > most || times < 1.0 / most)
      out.push_back({"unit", "model", text("%s comes out as %.3g %s where the model file has %.3g: is the unit of a channel or a size wrong by 1000?", e.name.c_str(), e.value, e.unit.c_str(), own->second)});
  }
  const auto look = [&](const Trial& t, const char* channel, double low, double high, const char* what, auto size) {
    if (!t.has(channel)) return;
    std::vector<double> there;
    for (const double v : t.at(channel))
      if (std::isfinite(v)) there.push_back(v);
    if (there.empty()) return;
    const double found = size(there);
    if (found >= low && found <= high) return;
    const Channel& c = d.channel(channel);
    out.push_back({"unit", t.file + ", " + channel, text("%s %.3g %s, expected %.3g to %.3g: is the unit wrong by 1000?", what, found / c.scale, c.unit.c_str(), low / c.scale, high / c.scale)});
  };
  const auto typical = [](const std::vector<double>& v) { return median(v); };
  const auto largest = [](const std::vector<double>& v) { return std::max(std::abs(*std::min_element(v.begin(), v.end())), std::abs(*std::max_element(v.begin(), v.end()))); };
  const auto spread = [](const std::vector<double>& v) { return *std::max_element(v.begin(), v.end()) - *std::min_element(v.begin(), v.end()); };
  for (const Trial& t : d.trials) {
    check_rate(d, t, out);
    check_clock_unit(d, t, out);
    if (d.rig == Rig::vessel_inflation) look(t, "outer_diameter", 0.2 * t.size("outer_diameter"), 5.0 * t.size("outer_diameter"), "usually", typical);
    if (d.rig == Rig::suture_pull || d.rig == Rig::needle_insertion) look(t, "speed", 2e-6, 1.0, "at most", largest);
    if (d.rig == Rig::forceps_bridge) look(t, "angle", 0.02, 3.2, "at most", largest);
    if (d.rig == Rig::suture_pull && t.has("hold_force") && t.has("pull_force")) {  // exp(1.5 wrap): friction no thread has
      const double hold = t.at("hold_force").cwiseAbs().maxCoeff(), wrap = t.at("wrap_angle").maxCoeff();
      look(t, "pull_force", 0.03 * hold, 3.0 * hold * std::exp(1.5 * wrap), "at most", largest);
    }
    if (d.rig == Rig::tip_hold)
      for (const std::string& axis : d.outputs) look(t, axis.c_str(), 1e-6, 0.02, "wanders by", spread);
  }
  return out;
}

}  // namespace filum::reconcile
