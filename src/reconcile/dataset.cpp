#include "reconcile/dataset.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>

#include "base/ensure.h"
#include "base/error.h"
#include "base/file_kind.h"
#include "base/hash.h"
#include "base/units.h"
#include "base/utf8.h"
#include "base/yaml_file.h"
#include "reconcile/csv_table.h"
#include "reconcile/plausible.h"
#include "reconcile/thin.h"
#include "reconcile/video_trial.h"

namespace filum::reconcile {
namespace {

namespace fs = std::filesystem;

bool is_marker(Rig rig, const std::string& name) {
  return rig == Rig::spatula_press && name.size() >= 2 && name[0] == 'u' &&
         std::all_of(name.begin() + 1, name.end(), [](char c) { return (c >= '0' && c <= '9') || c == 'x' || c == 'y' || c == 'z' || c == '_'; });
}

/// Refuses keys of a map that the contract does not know.
void check_keys(const YamlNode& node, const std::vector<KeyInfo>& known, Rig rig) {
  for (const std::string& key : node.keys()) {
    const bool ok = std::any_of(known.begin(), known.end(), [&](const KeyInfo& k) { return k.name == key; });
    if (ok) continue;
    std::string all;
    for (const KeyInfo& k : known) all += (all.empty() ? "" : ", ") + k.name;
    node.refuse(key, "one of the keys that " + info(rig).name + " knows here: " + all);
  }
}

/// A value of any dimension, or plain words.
std::string any_text(const YamlNode& node, const std::string& key) {
  std::string all;
  for (const std::string& t : node.scalars(key)) all += (all.empty() ? "" : ", ") + t;
  return all;
}

void read_specimen(const YamlNode& node, Dataset& d, std::map<std::string, double>& sizes, std::string& shape) {
  check_keys(node, info(d.rig).specimen, d.rig);
  for (const KeyInfo& key : info(d.rig).specimen) {
    if (!node.has(key.name)) continue;
    if (!key.words.empty()) shape = node.choice(key.name, key.words);
    else if (key.unit == "*") check_free_text(node, key, d);
    else if (key.unit == "#") sizes[key.name] = node.integer(key.name, 4, 32);
    else sizes[key.name] = plausible_size(node, key);
  }
}

void require_specimen(const YamlNode& file, Rig rig, const Trial& t) {
  const auto need = [&](const std::string& key) {
    if (t.specimen.count(key) == 0) file.map("specimen").refuse(key, "a size with a unit, e.g. \"5 mm\"");
  };
  for (const KeyInfo& key : info(rig).specimen) {
    if (!key.required) continue;
    if (key.words.empty()) need(key.name);
    else if (t.shape.empty()) file.map("specimen").refuse(key.name, "one of the words that " + info(rig).name + " knows");
  }
  if (rig != Rig::tissue_block) return;
  if (t.shape == "cylinder") need("diameter");
  else { need("length"); need("width"); }
}

Channel read_channel(const YamlNode& node, Rig rig) {
  Channel c;
  c.name = node.text("name");
  c.column = node.text_or("column", c.name);
  c.unit = node.text("unit");
  const auto& known = info(rig).channels;
  const auto found = std::find_if(known.begin(), known.end(), [&](const ChannelInfo& k) { return k.name == c.name; });
  std::string like = "m";
  if (found != known.end()) {
    like = found->unit;
    c.input = found->input;
  } else if (!is_marker(rig, c.name)) {
    std::string all;
    for (const ChannelInfo& k : known) all += (all.empty() ? "" : ", ") + k.name;
    node.refuse("name", "one of the channels of " + info(rig).name + ": " + all);
  }
  const std::string kind = node.has("kind") ? node.choice("kind", {"input", "output", "time"}) : "";
  if (kind == (c.input ? "output" : "input")) node.refuse("kind", c.input ? "input" : "output");
  try {
    if (dimension_of(c.unit) != dimension_of(like)) node.refuse("unit", "a unit like " + like);
    c.scale = c.unit == "degC" ? 1.0 : unit_scale(c.unit);
  } catch (const InputError& e) {
    if (e.field == "unit") node.refuse("unit", "a known unit like " + like);
    throw;
  }
  c.shift = c.unit == "degC" ? 273.15 : 0.0;
  if (node.has("noise")) {
    const std::string unit = c.unit == "degC" ? "K" : c.unit;
    c.noise = node.quantity("noise", unit, Range::positive());
  }
  return c;
}

void read_channels(const YamlNode& file, Dataset& d) {
  for (const YamlNode& node : file.items("channels")) {
    Channel c = read_channel(node, d.rig);
    for (const Channel& other : d.channels) {
      if (other.name == c.name) node.refuse("name", "each channel once");
      if (other.column == c.column) node.refuse(node.has("column") ? "column" : "name", "a column of its own, not that of " + other.name);
    }
    if (!c.input) d.outputs.push_back(c.name);
    d.channels.push_back(std::move(c));
  }
  for (const ChannelInfo& k : info(d.rig).channels) {
    const bool there = std::any_of(d.channels.begin(), d.channels.end(), [&](const Channel& c) { return c.name == k.name; });
    if (k.required && !there) file.refuse("channels", "a channel named " + k.name);
  }
  if (d.outputs.empty()) file.refuse("channels", "at least one output of " + info(d.rig).name);
}

/// A path beside experiment.yaml, else the name of a file below models/, with a parameter of the rig.
YamlNode load_model_file(const YamlNode& model, const Dataset& d, const std::string& root) {
  fs::path path = fs::path(d.folder) / d.model;
  if (!is_file(path)) path = fs::path(root) / "models" / (d.model + ".yaml");
  if (!is_file(path)) path = fs::path(root) / "models" / d.model;
  if (!is_file(path)) model.refuse("file", "a model below " + (fs::path(root) / "models").string() + ", e.g. " + info(d.rig).model + " (there is no such file), or a path beside experiment.yaml");
  YamlNode values = YamlNode::load(path.string());
  const auto& wanted = info(d.rig).baseline;
  if (!wanted.empty() && std::none_of(wanted.begin(), wanted.end(), [&](const ParameterInfo& p) { return values.has(p.name); }))
    model.refuse("file", "a model of " + info(d.rig).name + ", with " + wanted[0].name + ", e.g. " + info(d.rig).model);
  return values;
}

void read_model(const YamlNode& file, Dataset& d, const std::string& root) {
  for (const ParameterInfo& p : info(d.rig).baseline) d.nominal[p.name] = p.nominal;
  d.model = info(d.rig).model;
  for (const ParameterInfo& p : info(d.rig).baseline) d.free.push_back(p.name);
  if (!file.has("model")) return;
  const YamlNode model = file.map("model");
  d.model = model.text("file");
  const auto known = [&](const YamlNode& at, const std::string& key, const std::string& name) -> const ParameterInfo& {
    for (const ParameterInfo& p : info(d.rig).baseline)
      if (p.name == name) return p;
    std::string all;
    for (const ParameterInfo& p : info(d.rig).baseline) all += (all.empty() ? "" : ", ") + p.name;
    at.refuse(key, "names of baseline parameters, not \"" + name + "\": " + (all.empty() ? "none for this rig" : all));
  };
  if (model.has("free")) {
    d.free = model.texts("free");
    for (const std::string& name : d.free) known(model, "free", name);
  }
  if (model.has("prior")) {
    const YamlNode prior = model.map("prior");
    for (const std::string& name : prior.keys()) {
      const ParameterInfo& p = known(prior, name, name);
      const auto range = prior.quantities(name, p.unit);
      if (range.size() != 2 || !(range[0] < range[1])) prior.refuse(name, "two values with a unit, the lower one first");
      d.prior[name] = {range[0], range[1]};
    }
  }
  const YamlNode values = load_model_file(model, d, root);
  for (const ParameterInfo& p : info(d.rig).baseline) {
    if (!values.has(p.name)) continue;
    try {
      d.nominal[p.name] = values.quantity(p.name, p.unit);
    } catch (const InputError&) {
      d.nominal[p.name] = values.map(p.name).quantity("value", p.unit);
    }
  }
}

/// The clock must run forward without gaps in itself.
void check_time(const CsvTable& table, const std::string& column, const Eigen::VectorXd& time) {
  for (Eigen::Index i = 0; i < time.size(); ++i) {
    const std::string where = table.file + ":" + std::to_string(table.line[static_cast<std::size_t>(i)]);
    if (!std::isfinite(time[i])) throw InputError(where, "column " + column, "no time", "a time in every row");
    if (i > 0 && !(time[i] > time[i - 1])) {
      const std::string_view cell = table.cell(static_cast<std::size_t>(i), static_cast<std::size_t>(table.column(column)));
      throw InputError(where, "column " + column, "\"" + std::string(cell) + "\"",
                       "a time later than that of the row before: time is strictly increasing");
    }
  }
}

/// A channel of a video at the times of the trial; NaN beside lost frames and outside the video.
Eigen::VectorXd at_times(const Eigen::VectorXd& time, const Eigen::VectorXd& value, const Eigen::VectorXd& wanted) {
  Eigen::VectorXd out = Eigen::VectorXd::Constant(wanted.size(), NAN);
  Eigen::Index k = 0;
  for (Eigen::Index n = 0; n < wanted.size(); ++n) {
    if (wanted[n] < time[0] || wanted[n] > time[time.size() - 1]) continue;
    while (k + 2 < time.size() && time[k + 1] < wanted[n]) ++k;
    const double w = (wanted[n] - time[k]) / (time[k + 1] - time[k]);
    out[n] = w <= 0.0 ? value[k] : w >= 1.0 ? value[k + 1] : value[k] + w * (value[k + 1] - value[k]);
  }
  return out;
}

bool is_video(const fs::path& file) {
  const std::string kind = file.extension().string();
  return kind == ".mp4" || kind == ".avi" || kind == ".mkv" || kind == ".mov";
}

/// Channels of a video trial, the table beside it (same name, .csv) giving time and what no camera sees.
CsvTable read_video_samples(Dataset& d, Trial& t, const VideoSetup& setup) {
  const VideoChannels video = follow_video(setup, d.rig, t.word("mode"));
  const fs::path beside = fs::path(setup.file).replace_extension(".csv");
  const bool with_table = is_file(beside);
  CsvTable table;
  table.file = with_table ? beside.string() : setup.file;
  if (with_table) table = CsvTable::load(beside.string());
  const auto seen = [&](const Channel& c) { return video.value.count(c.name) > 0; };
  for (const Channel& c : d.channels)
    if (!seen(c) && !with_table && c.name != "time")
      throw InputError(setup.file, "channel " + c.name, "no table beside the video", beside.filename().string() + " with time and a column \"" + c.column + "\"");
  t.time = video.time;
  for (const Channel& c : d.channels) {
    if (seen(c) || !with_table) continue;
    Eigen::VectorXd v = (table.numbers(table.column(c.column)).array() * c.scale + c.shift).matrix();
    if (c.name == "time") check_time(table, c.column, v), t.time = std::move(v);
    else t.data[c.name] = std::move(v);
  }
  if (!with_table) table.line.assign(static_cast<std::size_t>(t.time.size()), 0);
  for (const Channel& c : d.channels) {
    if (!seen(c)) continue;
    t.data[c.name] = at_times(video.time, video.value.at(c.name), t.time);
    std::vector<double> sd;
    for (const double x : video.sd.at(c.name))
      if (std::isfinite(x) && x > 0) sd.push_back(x);
    if (!sd.empty()) std::nth_element(sd.begin(), sd.begin() + static_cast<std::ptrdiff_t>(sd.size() / 2), sd.end()), t.tracked[c.name] = sd[sd.size() / 2];
    std::ostringstream text;
    text << t.file << ": " << c.name << " followed in the video, 1 sd of a sample " << t.tracked[c.name] << " m";
    d.note(text.str());
  }
  for (const std::string& n : video.notices) d.note(t.file + ": " + n);
  return table;
}

CsvTable read_table_samples(Dataset& d, Trial& t, const std::string& path) {
  CsvTable table = CsvTable::load(path);
  for (const Channel& c : d.channels) {
    Eigen::VectorXd v = (table.numbers(table.column(c.column)).array() * c.scale + c.shift).matrix();
    if (c.name == "time") check_time(table, c.column, v), t.time = std::move(v);
    else t.data[c.name] = std::move(v);
  }
  const auto used = [&](const std::string& h) { return std::any_of(d.channels.begin(), d.channels.end(), [&](const Channel& c) { return c.column == h; }); };
  for (const std::string& h : table.header)
    if (!used(h)) d.note(t.file + ": column \"" + h + "\" is not a channel and was ignored");
  if (t.time.size() == 0) {
    t.clocked = false;
    t.time = Eigen::VectorXd::LinSpaced(static_cast<Eigen::Index>(table.rows()), 0.0, static_cast<double>(table.rows()) - 1.0);
  }
  return table;
}

void read_samples(Dataset& d, Trial& t, const std::optional<VideoSetup>& video) {
  const std::string path = (fs::path(d.folder) / t.file).string();
  const CsvTable table = video ? read_video_samples(d, t, *video) : read_table_samples(d, t, path);
  for (const Channel& c : d.channels) {
    if (c.name == "time") continue;
    bool whole = true;
    for (const double x : t.at(c.name)) t.missing += std::isfinite(x) ? 0 : 1, whole = whole && std::isfinite(x);
    if (c.input && !whole) d.note(t.file + ": input " + c.name + " has missing samples; those rows are left out");
  }
  check_samples(d, t, table);
  if (t.missing > 0) d.note(t.file + ": " + std::to_string(t.missing) + " missing samples, left out");
  const int least = d.rig == Rig::tip_hold ? 64 : 4;  // a still hand is judged by its spectrum
  if (t.samples() < least) throw InputError(path, "rows", std::to_string(t.samples()), "at least " + std::to_string(least) + " samples");
  const auto add = [&](const Eigen::VectorXd& v) { d.hash = hash_bytes(v.data(), sizeof(double) * static_cast<std::size_t>(v.size()), d.hash); };
  add(t.time);
  for (const Channel& c : d.channels)
    if (c.name != "time") add(t.at(c.name));
}

/// Rows whose inputs are missing cannot be simulated.
void drop_rows_without_input(const Dataset& d, Trial& t) {
  std::vector<Eigen::Index> keep;
  for (Eigen::Index i = 0; i < t.time.size(); ++i) {
    bool whole = true;
    for (const Channel& c : d.channels) whole = whole && (!c.input || c.name == "time" || std::isfinite(t.at(c.name)[i]));
    if (whole) keep.push_back(i);
  }
  if (static_cast<Eigen::Index>(keep.size()) == t.time.size()) return;
  if (keep.size() < 4) throw InputError((fs::path(d.folder) / t.file).string(), "rows", std::to_string(keep.size()) + " with all inputs", "at least 4");
  t.time = Eigen::VectorXd(t.time(keep));
  for (auto& [name, v] : t.data) v = Eigen::VectorXd(v(keep));
}

void read_trial(const YamlNode& file, const YamlNode& node, Dataset& d, const Trial& common) {
  Trial t = common;
  t.file = node.text("file");
  const fs::path path(t.file);
  if (path.is_absolute() || std::find(path.begin(), path.end(), "..") != path.end()) node.refuse("file", "a file inside the dataset's folder");
  const bool video = is_video(path);
  if (path.extension() != ".csv" && !video) node.refuse("file", "a .csv file or a video (.mp4, .avi, .mkv, .mov)");
  if (!node.has("video") && video) node.refuse("video", "a map with scale (length of a pixel) and points (name, x, y in the first frame) for a video");
  for (const Trial& other : d.trials)
    if (other.file == t.file) node.refuse("file", "each file once");
  if (!is_there(fs::path(d.folder) / path)) node.refuse("file", "a file in the dataset's folder (no such file: " + (fs::path(d.folder) / path).string() + ")");
  t.repeat = node.text_or("repeat", "");
  t.hold_out = node.flag_or("hold_out", false);
  if (node.has("specimen")) read_specimen(node.map("specimen"), d, t.specimen, t.shape);
  require_specimen(file, d.rig, t);
  check_specimen(node.has("specimen") ? node.map("specimen") : file.map("specimen"), file.map("specimen"), d.rig, t);
  const bool needs_mode = d.rig == Rig::tissue_block;
  if (node.has("protocol")) {
    const YamlNode protocol = node.map("protocol");
    check_keys(protocol, info(d.rig).protocol, d.rig);
    for (const KeyInfo& key : info(d.rig).protocol) {
      if (!protocol.has(key.name)) {
        if (key.required) protocol.refuse(key.name, "one of compression, tension, shear");
        continue;
      }
      if (key.unit == "*") check_free_text(protocol, key, d);
      t.protocol[key.name] = key.words.empty() ? any_text(protocol, key.name) : protocol.choice(key.name, key.words);
      if (key.unit == "m" || key.unit == "s") protocol.quantity(key.name, key.unit, Range::not_negative());
      if (key.name == "overhang") t.specimen["overhang"] = plausible_size(protocol, key);
    }
  } else if (needs_mode) {
    node.refuse("protocol", "a map with at least mode: compression, tension or shear");
  }
  std::optional<VideoSetup> setup;
  if (video) setup = read_video(node.map("video"), (fs::path(d.folder) / t.file).string(), d.rig);
  read_samples(d, t, setup);
  drop_rows_without_input(d, t);
  d.trials.push_back(std::move(t));
  std::size_t all = 0;
  for (const Trial& trial : d.trials) all += static_cast<std::size_t>(trial.samples());
  if (all > CsvTable::kMostRows) throw InputError((fs::path(d.folder) / d.trials.back().file).string(), "rows", std::to_string(all) + " in all trials so far", "at most " + std::to_string(CsvTable::kMostRows) + " in all: fewer samples, or fewer trials");
}

void read_trials(const YamlNode& file, Dataset& d) {
  Trial common;
  if (file.has("specimen")) read_specimen(file.map("specimen"), d, common.specimen, common.shape);
  else file.refuse("specimen", "the sizes of the specimen");
  for (const YamlNode& node : file.items("trials")) read_trial(file, node, d, common);
  if (d.trials.empty()) file.refuse("trials", "at least one trial");
  const auto held = std::count_if(d.trials.begin(), d.trials.end(), [](const Trial& t) { return t.hold_out; });
  if (held == static_cast<std::ptrdiff_t>(d.trials.size())) file.refuse("trials", "at least one trial that is not held out");
  check_constant(d);
  check_noise(d);
  if (d.trials.size() == 1) d.note("one trial only: nothing can be held out, and evidence comes from a single record");
  std::map<std::string, int> letters;
  for (const Trial& t : d.trials)
    if (!t.repeat.empty()) ++letters[t.repeat];
  if (std::none_of(letters.begin(), letters.end(), [](const auto& l) { return l.second > 1; }))
    d.note("no replicates: the noise is as stated, or taken from the fast part of the signals");
}

}  // namespace

double Trial::size(const std::string& key, double otherwise) const {
  const auto found = specimen.find(key);
  return found == specimen.end() ? otherwise : found->second;
}

std::string Trial::word(const std::string& key) const {
  const auto found = protocol.find(key);
  return found == protocol.end() ? "" : found->second;
}

void Dataset::note(const std::string& text) {
  if (std::find(notices.begin(), notices.end(), text) == notices.end()) notices.push_back(text);
}

const Channel& Dataset::channel(const std::string& name) const {
  const auto found = std::find_if(channels.begin(), channels.end(), [&](const Channel& c) { return c.name == name; });
  ENSURE(found != channels.end(), "a channel of the dataset");
  return *found;
}

std::string Dataset::protocol_text(const Trial& trial) const {
  std::string text = trial.shape;
  for (const auto& [key, value] : trial.protocol) text += " " + key + "=" + value;
  for (const auto& [key, value] : trial.specimen) text += " " + key + "=" + std::to_string(value * 1e6);
  return text;
}

Dataset load_dataset(const std::string& folder, const std::string& root) {
  Dataset d;
  d.folder = folder;
  fs::path path = fs::path(folder).lexically_normal();
  if (!path.has_filename()) path = path.parent_path();
  d.name = with_utf8_only(fs::absolute(path).filename().string());
  if (!is_folder(folder)) throw InputError(folder, "dataset", "no such folder", "a folder with experiment.yaml");
  const YamlNode file = YamlNode::load(folder + "/experiment.yaml");
  std::ostringstream text;
  text << std::ifstream(folder + "/experiment.yaml", std::ios::binary).rdbuf();
  d.hash = hash_text(text.str());
  file.choice("format", {"filum-experiment/1"});
  d.title = file.text_or("title", d.name);
  d.source = file.text_or("source", "");
  const auto rig = rig_named(file.text("rig"));
  if (!rig) {
    std::string all;
    for (const RigInfo& r : rigs()) all += (all.empty() ? "" : ", ") + r.name;
    file.refuse("rig", "one of " + all);
  }
  d.rig = *rig;
  read_model(file, d, root);
  read_channels(file, d);
  read_trials(file, d);
  thin(d);
  file.finish();
  return d;
}

}  // namespace filum::reconcile
