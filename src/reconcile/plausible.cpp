#include "reconcile/plausible.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <sstream>

#include "base/error.h"
#include "base/units.h"

namespace filum::reconcile {
namespace {

namespace fs = std::filesystem;

/// The unit a thousand times smaller or larger in which this value would be possible: "m" -> "mm"; empty if there is none.
std::string unit_meant(double value, const std::string& unit, const KeyInfo& key) {
  std::vector<std::string> roots = {unit};
  if (unit.size() > 1) roots.push_back(unit.substr(1));
  for (const std::string& root : roots)
    for (const char* prefix : {"", "m", "u", "n", "k", "M"}) {
      std::string other = prefix;
      other += root;
      try {
        if (dimension_of(other) != dimension_of(unit)) continue;
        const double times = unit_scale(other) / unit_scale(unit), would = value * times;
        if (std::abs(std::abs(std::log10(times)) - 3.0) < 1e-6 && would >= key.low && would <= key.high) return other;
      } catch (const InputError&) {  // no such unit
      }
    }
  return "";
}

bool begins_like_a_number(const std::string& text) { return !text.empty() && (std::isdigit(static_cast<unsigned char>(text[0])) != 0 || text[0] == '-' || text[0] == '+' || text[0] == '.'); }

/// Whether a text is a value that is not negative with one of these units.
bool is_quantity(const std::string& text, const std::vector<std::string>& units) {
  return std::any_of(units.begin(), units.end(), [&](const std::string& unit) {
    try {
      return parse_quantity(text, unit) >= 0.0;
    } catch (const InputError&) {
      return false;
    }
  });
}

/// Units that a key of free form may have on a rig, with an example.
std::pair<std::vector<std::string>, std::string> units_of(const KeyInfo& key, Rig rig) {
  if (key.name == "rate" && rig == Rig::vessel_inflation) return {{"Pa/s", "m/s", "m3/s", "1/s"}, "a rate with its unit, e.g. \"500 Pa/s\" (a word without a number, such as slow, is a label)"};
  if (key.name == "rate" && rig == Rig::forceps_bridge) return {{"rad/s", "N/s", "1/s"}, "a rate with its unit, e.g. \"10 deg/s\" (a word without a number, such as slow, is a label)"};
  if (key.name == "rate") return {{"m/s", "1/s", "N/s", "Pa/s"}, "a rate with its unit, e.g. \"0.1 mm/s\" or \"0.01 1/s\" (a word without a number, such as slow, is a label)"};
  if (key.name == "cycle") return {{"-", "s", "1/s"}, "a number of cycles, e.g. 3, or their time, e.g. \"2 s\""};
  if (key.name == "layers") return {{"-", "m"}, "the number of layers, e.g. 2, their names or their thicknesses, e.g. \"1 mm\""};
  return {{"m", "-"}, "lengths with a unit, e.g. \"2 mm\", or shares, e.g. \"0.6\""};
}

std::string lines_of(const Trial& t, const CsvTable& table) {
  return table.line.empty() || table.line.back() == 0 ? (table.file.empty() ? t.file : table.file) : table.file + ":" + std::to_string(table.line.front()) + "-" + std::to_string(table.line.back());
}

std::string number(double v) {
  std::ostringstream s;
  s << '"' << v << '"';
  return s.str();
}

/// Samples that cannot be: mostly a unit that is wrong by a thousand.
void check_sizes(const Dataset& d, const Trial& t, const CsvTable& table) {
  const auto within = [&](const std::string& channel, double low, double high, const std::string& what, const std::string& ask) {
    if (!t.has(channel)) return;
    const Eigen::VectorXd& v = t.at(channel);
    const Channel& c = d.channel(channel);
    for (Eigen::Index i = 0; i < v.size(); ++i)
      if (std::isfinite(v[i]) && (v[i] > high || v[i] < low))
        throw InputError(table.file + ":" + std::to_string(table.line[static_cast<std::size_t>(i)]), "column " + c.column,
                         number((v[i] - c.shift) / c.scale) + " " + c.unit, what + " (" + ask + ")");
  };
  const auto refuse = [&](const std::string& channel, double limit, const std::string& what) { within(channel, -limit, limit, what, "is the unit wrong by 1000?"); };
  if (d.rig == Rig::tissue_block) {
    const bool compression = t.word("mode") == "compression";
    refuse("displacement", t.size("height") * (compression ? 1.0 : 20.0), compression ? "less than the specimen's height" : "at most 20 times the specimen's height");
  }
  if (d.rig == Rig::spatula_press) refuse("depth", t.size("height"), "less than the tissue's height");
  if (d.rig == Rig::vessel_inflation) {
    refuse("outer_diameter", 20.0 * t.size("outer_diameter"), "at most 20 times the specimen's outer diameter");
    within("axial_stretch", 0.1, 10.0, "a ratio of lengths from 0.1 to 10", "1 is the unstretched tube; percent?");
  }
  if (d.rig == Rig::needle_insertion) refuse("depth", 0.5, "a depth of at most 0.5 m"), refuse("speed", 10.0, "at most 10 m/s");
  if (d.rig == Rig::suture_pull) refuse("speed", 10.0, "at most 10 m/s"), refuse("hold_force", 1e3, "at most 1 kN");
  if (d.rig == Rig::forceps_bridge) refuse("angle", 60.0, "at most 60 rad, ten turns"), refuse("grip_force", 1e4, "at most 10 kN");
  if (d.rig == Rig::vessel_inflation) refuse("pressure", 1e8, "at most 100 MPa");
  if (d.rig == Rig::suture_pull) within("wrap_angle", -60.0, 60.0, "at most 60 rad, ten turns", "is the unit deg?");
  if (d.rig == Rig::forceps_bridge) within("temperature", 200.0, 450.0, "200 K to 450 K", "kelvin and degC mixed up?");
  if (d.rig == Rig::suture_cantilever) {
    refuse("overhang", 0.5, "an overhang of at most 0.5 m");
    const double longest = t.has("overhang") ? t.at("overhang").maxCoeff() : t.size("overhang");
    if (longest > 0.0) refuse("tip_drop", 3.0 * longest, "a drop of at most three times the overhang");
  }
}

/// One sample (or two, three) a thousand times beyond all others would be the full scale by which everything is judged: a lost dot, or a sensor that failed.
void check_spike(const Trial& t, const CsvTable& table, const Channel& c) {
  const Eigen::VectorXd& v = t.at(c.name);
  std::vector<std::pair<double, Eigen::Index>> sorted;
  for (Eigen::Index i = 0; i < v.size(); ++i)
    if (std::isfinite(v[i])) sorted.emplace_back(v[i], i);
  if (sorted.size() < 12) return;
  std::sort(sorted.begin(), sorted.end());
  const std::size_t n = sorted.size();
  const double rest = sorted[n - 4].first - sorted[3].first, whole = sorted[n - 1].first - sorted[0].first;
  if (!(rest > 0.0) || whole < 1000.0 * rest) return;
  const double middle = sorted[n / 2].first;
  const Eigen::Index at = std::abs(sorted[0].first - middle) > std::abs(sorted[n - 1].first - middle) ? sorted[0].second : sorted[n - 1].second;
  throw InputError(table.file + ":" + std::to_string(table.line[static_cast<std::size_t>(at)]), "column " + c.column, number((v[at] - c.shift) / c.scale) + " " + c.unit,
                   "a sample less than a thousand times beyond all others of its record (leave the cell empty where the sensor failed)");
}

/// Whether a channel takes more than one value over all trials.
bool moves(const Dataset& d, const std::string& name) {
  double first = NAN;
  for (const Trial& t : d.trials)
    for (const double x : t.at(name)) {
      if (!std::isfinite(x)) continue;
      if (std::isnan(first)) first = x;
      if (x != first) return true;
    }
  return false;
}

void check_output(Dataset& d, const Trial& t, const CsvTable& table, const std::string& name) {
  const Eigen::VectorXd& v = t.at(name);
  double low = INFINITY, high = -INFINITY;
  int there = 0;
  for (const double x : v)
    if (std::isfinite(x)) low = std::min(low, x), high = std::max(high, x), ++there;
  if (there == 0) throw InputError(lines_of(t, table), "column " + d.channel(name).column, "no sample at all", "at least one number in an output channel");
  check_spike(t, table, d.channel(name));
  if (there > 2 && low == high) d.note(t.file + ": channel " + name + " is constant: nothing was measured there or the channel is dead");
}

}  // namespace

double plausible_size(const YamlNode& node, const KeyInfo& key) {
  const double value = node.quantity(key.name, key.unit, Range::positive());
  if (key.high <= 0.0 || (value >= key.low && value <= key.high)) return value;
  const std::string text = node.text(key.name);
  const std::size_t letters = text.find_first_not_of("+-.0123456789eE \t");
  const std::string unit = letters == std::string::npos ? "-" : text.substr(letters);
  const auto bound = [&](double v) { return key.unit.size() > 1 ? format_quantity(v, key.unit) : format_prefixed(v, key.unit); };
  const std::string meant = unit_meant(value, unit, key);
  node.refuse(key.name, bound(key.low) + " to " + bound(key.high) + " (" + (meant.empty() ? "is the unit right?" : "did you mean " + meant + "?") + ")");
}

void check_free_text(const YamlNode& node, const KeyInfo& key, Dataset& d) {
  const auto [units, example] = units_of(key, d.rig);
  const auto texts = node.scalars(key.name);
  if (texts.empty()) node.refuse(key.name, example);
  for (const std::string& text : texts) {
    if (text.empty() || text.size() > 200) node.refuse(key.name, example);
    if (begins_like_a_number(text) && !is_quantity(text, units)) node.refuse(key.name, example);
    const double count = key.name == "layers" && is_quantity(text, {"-"}) ? parse_quantity(text, "-") : 1.0;
    if (count < 1.0 || count > 20.0 || count != std::floor(count)) node.refuse(key.name, "a whole number of layers from 1 to 20");
    if (key.name == "rate" && !begins_like_a_number(text)) d.note("rate \"" + text + "\" is no number and is taken for a label");
  }
}

void check_specimen(const YamlNode& own, const YamlNode& common, Rig rig, const Trial& t) {
  const auto below = [&](const char* key, double limit, const std::string& expected) {
    if (t.size(key) > limit) (own.has(key) ? own : common).refuse(key, expected + format_prefixed(limit, "m"));
  };
  if (rig == Rig::vessel_inflation) below("wall_thickness", 0.4999 * t.size("outer_diameter"), "less than half the outer diameter, ");
  if (rig != Rig::spatula_press) return;
  const double most = 2.0 * std::max(t.size("length"), t.size("width"));
  below("blade_length", most, "at most twice the tissue's length, ");
  below("blade_width", most, "at most twice the tissue's length, ");
}

void check_samples(Dataset& d, const Trial& t, const CsvTable& table) {
  check_sizes(d, t, table);
  for (const Channel& c : d.channels)
    if (c.input && c.name != "time") check_spike(t, table, c);
  for (const std::string& name : d.outputs) check_output(d, t, table, name);
}

void check_constant(Dataset& d) {
  bool inputs = false, moved = d.rig == Rig::tip_hold;
  for (const Channel& c : d.channels)
    if (c.input && c.name != "time") inputs = true, moved = moved || moves(d, c.name);
  if (inputs && !moved) d.note("no input changes in any trial: how the outputs answer cannot be learnt from them");
  for (const Channel& c : d.channels) {
    if (c.input || !moved || moves(d, c.name)) continue;
    if (d.rig == Rig::tip_hold && d.outputs.size() > 1) {
      d.note("channel " + c.name + " never changes and was left out");
      std::erase(d.outputs, c.name);
      continue;
    }
    throw InputError((fs::path(d.folder) / d.trials[0].file).string(), "column " + c.column, "the same value in every row of every trial", "an output that answers to its inputs (a dead channel? leave it out of channels)");
  }
}

void check_noise(const Dataset& d) {
  constexpr double kMost = 10.0;  // of a channel's range: noise alone spans some two of its standard deviations in four samples
  for (const Channel& c : d.channels) {
    if (c.noise <= 0.0 || c.name == "time") continue;
    double low = INFINITY, high = -INFINITY;
    for (const Trial& t : d.trials)
      for (const double x : t.at(c.name))
        if (std::isfinite(x)) low = std::min(low, x), high = std::max(high, x);
    if (!(high > low) || c.noise <= kMost * (high - low)) continue;
    throw InputError((fs::path(d.folder) / "experiment.yaml").string(), "noise of channel " + c.name, number(c.noise / c.scale) + " " + c.unit,
                     "at most ten times the range of its samples, " + number((high - low) / c.scale) + " " + c.unit + " (is the unit right?)");
  }
}

}  // namespace filum::reconcile
