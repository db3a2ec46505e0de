#include "devices/pose_script.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>
#include <utility>

#include "base/yaml_file.h"

// format: filum-demonstration/1
// title: Square knot by instrument tie
// tools:
//   - tool: 0
//     keys:
//       - { t: 0 s, p: [-4 mm, 0 mm, 6 mm], handle: [-0.5, 0, 0.85], opening: [0, 1, 0], grip: 12 deg }
//       - { t: 2 s, p: [0 mm, 0 mm, 5 mm], buttons: [cut], stop: true, say: Pick up the short end }
//       - { t: 3 s, arc: { centre: [0 mm, 0 mm, 5 mm], axis: [0, 1, 0], turns: -1.25, rise: 1 mm } }
// A key without p, handle, opening or grip keeps that of the key before. A grip below zero squeezes beyond
// closure. grip_force is optional, for all keys of a tool or none. An arc key without p ends where its turns,
// radius (default: unchanged) and rise (default: 0) lead. A key may be given in the frame of what is seen at the moment the hand sets out
// for it, and so are those after it until the next `at` (sight.h says which way the axes point; `at: {}` is the scene again):
//       - { t: 4 s, at: { needle: 3.4 mm }, p: [2 mm, 0 mm, 0 mm], handle: [0, 0, 1], opening: [1, 0, 0] }
//   at: { needle: ARC from the swage } { thread: LENGTH, from: swage | end }
//   { knot: LENGTH from it, from: swage | end } { entry: N } { exit: N } { edge: N } { tool: N }; N as in "the first way
//   through the tissue" from 1, stumps and tools from 0. With `axes: scene` the place is seen and directions stay the scene's; with `bring: ARC` the
//   keys are poses of the needle there (opening: outwards, handle: its normal), and the tool carries it as it then holds it. With
//   `follow: true` the hand does not look once but all the way, and goes after what moves (with a lag of 0.1 s); what it loses sight of it
//   expects where it was.
// A hand that pulls may feel when it is enough: it stops on its way where the scene has pulled at its tool as hard for 10 ms, and stays there
// until the key's time and through the keys after it that give no place. If it never does, it goes all the way:
//       - { t: 6 s, p: [0 mm, 9 mm, 1 mm], until: { pull: 15 mN } }
// A tool may have `tremor: { rms: 60 um, frequency: 9 Hz, width: 2 Hz }`.

namespace filum {
namespace {

constexpr double kReach = 0.2;            // [m], from the origin: what is farther was written by mistake
constexpr double kTurnsTolerance = 0.02;  // arc.turns and p must agree to this; then p decides

std::uint32_t read_buttons(const YamlNode& node) {
  static const std::pair<const char*, std::uint32_t> kNames[] = {{"clutch", 1}, {"cut", 2}, {"next", 4}, {"fresh", 32}};
  std::uint32_t buttons = 0;
  if (!node.has("buttons")) return buttons;
  for (const std::string& text : node.texts("buttons")) {
    const auto* name =
        std::find_if(std::begin(kNames), std::end(kNames), [&](const auto& n) { return text == n.first; });
    if (name == std::end(kNames))
      node.refuse("buttons", "a list of clutch, cut, next, fresh (\"" + text + "\" is none)");
    buttons |= name->second;
  }
  return buttons;
}

Vec3 read_direction(const YamlNode& node, const std::string& key) {
  const Vec3 direction = node.vec3(key, "-");
  if (!(direction.norm() > 1e-6)) node.refuse(key, "a direction, not zero");
  return direction.normalized();
}

/// `at: { ... }` of a key.
PoseLook read_look(const YamlNode& node, int tool) {
  static const std::pair<const char*, Look::Kind> kKinds[] = {{"needle", Look::Kind::needle}, {"thread", Look::Kind::thread}, {"knot", Look::Kind::knot}, {"entry", Look::Kind::entry},
                                                              {"exit", Look::Kind::exit},     {"edge", Look::Kind::edge},     {"tool", Look::Kind::tool}};
  static const std::string kWords[] = {"needle", "thread", "knot", "entry", "exit", "edge", "tool", "from", "axes", "bring", "follow"};
  for (const std::string& key : node.keys())
    if (std::find(std::begin(kWords), std::end(kWords), key) == std::end(kWords)) node.refuse(key, "needle, thread, knot, entry, exit, edge or tool, with from, axes, bring, follow");
  PoseLook look;
  for (const auto& [name, kind] : kKinds) {
    if (!node.has(name)) continue;
    if (look.at.kind != Look::Kind::scene) node.refuse(name, "one of needle, thread, knot, entry, exit, edge, tool");
    look.at.kind = kind;
    if (kind == Look::Kind::needle || kind == Look::Kind::thread || kind == Look::Kind::knot)
      look.at.length = node.quantity(name, "m", Range::between(0.0, 1.0));
    else if (kind == Look::Kind::tool)
      look.at.index = node.integer(name, 0, kMaxTools - 1);
    else if (kind == Look::Kind::edge)
      look.at.index = node.integer(name, 0, 1);
    else
      look.at.index = node.integer(name, 1, 40) - 1;
  }
  if (look.at.kind == Look::Kind::thread || look.at.kind == Look::Kind::knot) look.at.from_end = node.choice("from", {"swage", "end"}) == "end";
  if (node.has("axes")) look.at.scene_axes = node.choice("axes", {"scene"}) == "scene";
  if (node.has("bring")) look.bring = node.quantity("bring", "m", Range::between(0.0, 0.05));
  look.follow = node.flag_or("follow", false);
  if (look.follow && look.at.kind == Look::Kind::scene) node.refuse("follow", "something to follow: needle, thread, knot, entry, exit, edge or tool");
  if (look.follow && look.at.kind == Look::Kind::tool && look.at.index == tool) node.refuse("tool", "another tool than the one that follows");
  if (look.bring && look.at.kind == Look::Kind::tool && look.at.index == tool) node.refuse("tool", "another tool than the one that brings the needle");
  return look;
}

/// Reads the keys of one tool; handle and opening are kept as written so that a key may change one of them.
class KeyReader {
 public:
  explicit KeyReader(int tool) : tool_(tool) {}
  PoseKey read(const YamlNode& node, bool first) {
    PoseKey key;
    key.t = node.quantity("t", "s", Range::between(0.0, 3600.0));
    if (!first && !(key.t > last_.t)) node.refuse("t", "later than the key before");
    read_place(node, first, key);
    read_tip(node, first, key);
    read_direction_pair(node, first);
    key.q = orientation(node);
    key.grip_angle = first ? node.quantity("grip", "rad", kAngles)
                           : node.quantity_or("grip", "rad", last_.grip_angle, kAngles);
    const bool says_force = node.has("grip_force");
    if (!first && says_force && !has_force_)
      node.refuse("grip_force", "none, because the first key of this tool has none");
    if (first) has_force_ = says_force;
    key.grip_force =
        node.quantity_or("grip_force", "N", first ? 0.0 : last_.grip_force, Range::between(0.0, 50.0));
    key.buttons = read_buttons(node);
    key.stop = node.flag_or("stop", false);
    read_until(node, first, key);
    key.say = node.text_or("say", first ? "" : last_.say);
    last_ = key;
    return key;
  }
  bool has_force() const { return has_force_; }
  std::vector<PoseLook> looks() const { return looks_; }

 private:
  static constexpr Range kAngles = {-std::numbers::pi / 6, std::numbers::pi / 2, false};

  void read_place(const YamlNode& node, bool first, PoseKey& key) {
    key.look = first ? -1 : last_.look;
    if (!node.has("at")) return;
    if (first) node.refuse("at", "none on the first key: the hand looks at the key before");
    const PoseLook look = read_look(node.map("at"), tool_);
    for (const char* field : {"p", "handle", "opening"})
      if (!node.has(field)) node.refuse(field, "p, handle and opening beside at: those of the key before are in another frame");
    if (node.has("arc")) node.refuse("arc", "none beside at: it would start in another frame");
    key.look = -1;
    if (look.at.kind == Look::Kind::scene && !look.bring) return;
    key.look = static_cast<int>(looks_.size());
    looks_.push_back(look);
  }

  void read_until(const YamlNode& node, bool first, PoseKey& key) const {
    key.keeps_place = !node.has("p") && !node.has("arc");
    key.keeps_turn = !node.has("handle") && !node.has("opening");
    if (!node.has("until")) return;
    if (first) node.refuse("until", "none on the first key: the hand feels on its way");
    key.until_pull = node.map("until").quantity("pull", "N", {1e-4, 10.0, false});
  }

  void read_tip(const YamlNode& node, bool first, PoseKey& key) const {
    if (first && node.has("arc"))
      node.refuse("arc", "none on the first key: an arc starts at the key before");
    if (node.has("arc") && key.look >= 0 && looks_.back().bring) node.refuse("arc", "none where a needle is brought: p is not the jaws' tip");
    if (first || node.has("p")) key.p_W = node.vec3("p", "m");
    if (!first && !node.has("p")) key.p_W = last_.p_W;
    if (!first && node.has("arc")) read_arc(node, key);
    // Written so that NaN is refused too.
    if (!(key.p_W.cwiseAbs().maxCoeff() <= kReach))
      node.refuse(node.has("p") ? "p" : "arc", "within 200 mm of the origin");
  }

  void read_arc(const YamlNode& node, PoseKey& key) const {
    const YamlNode map = node.map("arc");
    PoseArc arc;
    arc.centre_W = map.vec3("centre", "m");
    arc.axis_W = read_direction(map, "axis");
    arc.turns = map.number("turns", Range::between(-20.0, 20.0));
    const double start = axis_distance(arc, last_.p_W);
    if (!(start > 1e-6)) map.refuse("centre", "an axis that does not pass through the tip at the key before");
    const bool has_p = node.has("p");
    if (has_p && (map.has("radius") || map.has("rise")))
      map.refuse(map.has("radius") ? "radius" : "rise", "none, because p is given");
    const double radius = map.quantity_or("radius", "m", start, {1e-6, kReach, false});
    const double rise = map.quantity_or("rise", "m", 0.0, Range::between(-kReach, kReach));
    if (!has_p) key.p_W = arc_end(arc, last_.p_W, radius, rise);
    if (!(axis_distance(arc, key.p_W) > 1e-6)) node.refuse("p", "a point off the axis of the arc");
    const double fitting = fitting_turns(arc, last_.p_W, key.p_W);
    if (!(std::abs(fitting - arc.turns) < kTurnsTolerance)) {
      std::ostringstream expected;
      expected << "turns that end at p; the nearest are " << fitting;
      map.refuse("turns", expected.str());
    }
    key.arc = arc;
  }

  void read_direction_pair(const YamlNode& node, bool first) {
    if (first || node.has("handle")) handle_ = read_direction(node, "handle");
    if (first || node.has("opening")) opening_ = read_direction(node, "opening");
  }

  Quat orientation(const YamlNode& node) const {
    const Vec3 across = opening_ - opening_.dot(handle_) * handle_;
    if (!(across.norm() > 0.05))
      node.refuse(node.has("opening") ? "opening" : "handle", "handle and opening at least 3 deg apart");
    Mat3 R;
    R.col(2) = handle_;
    R.col(0) = across.normalized();
    R.col(1) = R.col(2).cross(R.col(0));
    return Quat(R).normalized();
  }

  int tool_;
  std::vector<PoseLook> looks_;
  PoseKey last_;
  Vec3 handle_ = Vec3::UnitZ(), opening_ = Vec3::UnitX();
  bool has_force_ = false;
};

PoseTrack read_tool(const YamlNode& node) {
  const int tool = node.integer("tool", 0, kMaxTools - 1);
  KeyReader reader(tool);
  std::vector<PoseKey> keys;
  for (const YamlNode& item : node.items("keys")) keys.push_back(reader.read(item, keys.empty()));
  if (keys.empty()) node.refuse("keys", "at least one key");
  PoseTrack track(tool, std::move(keys), reader.has_force(), reader.looks());
  if (node.has("tremor")) {
    const YamlNode tremor = node.map("tremor");
    track.shake({tremor.quantity("rms", "m", {0.0, 1e-3, false}), tremor.quantity("frequency", "Hz", {1.0, 30.0, false}),
                 tremor.quantity("width", "Hz", {0.0, 5.0, false})});
  }
  return track;
}

}  // namespace

PoseScript PoseScript::load(const std::string& path) {
  return PoseScript(YamlNode::load(path));
}

PoseScript PoseScript::parse(std::string_view text, const std::string& file_name) {
  return PoseScript(YamlNode::parse(text, file_name));
}

PoseScript::PoseScript(const YamlNode& file) {
  file.choice("format", {"filum-demonstration/1"});
  title_ = file.text("title");
  for (const YamlNode& node : file.items("tools")) {
    PoseTrack track = read_tool(node);
    auto& slot = tracks_[static_cast<std::size_t>(track.tool())];
    if (slot) node.refuse("tool", "each tool once");
    duration_ = std::max(duration_, track.keys().back().t);
    slot = std::move(track);
  }
  if (n_tools() == 0) file.refuse("tools", "at least one tool");
  file.finish();
}

bool PoseScript::has_tool(int tool) const noexcept {
  return tool >= 0 && tool < kMaxTools && tracks_[static_cast<std::size_t>(tool)].has_value();
}

int PoseScript::n_tools() const noexcept {
  int n = 0;
  for (int tool = 0; tool < kMaxTools; ++tool)
    if (has_tool(tool)) n = tool + 1;
  return n;
}

DeviceSample PoseScript::at(int tool, double t) const noexcept {
  if (has_tool(tool)) return tracks_[static_cast<std::size_t>(tool)]->at(t);
  DeviceSample nothing;
  nothing.tool = tool;
  return nothing;
}

const std::string& PoseScript::say(int tool, double t) const noexcept {
  static const std::string kNothing;
  if (!has_tool(tool)) return kNothing;
  const PoseTrack& track = *tracks_[static_cast<std::size_t>(tool)];
  return t < track.keys().front().t ? kNothing : track.keys()[track.key_at(t)].say;
}

}  // namespace filum
