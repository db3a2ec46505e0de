#include "world/vessel_file.h"

#include <filesystem>
#include <numbers>

#include "base/error.h"
#include "world/describe.h"
#include "world/model_file.h"
#include "world/needle_model.h"
#include "world/vessel_state.h"
#include "world/wall_file.h"

namespace filum {
namespace {

// What is sewn under a microscope, widely taken: a slip of unit or exponent is refused, no tissue is.
constexpr Range kLayerThickness{1e-6, 5e-3};   // [m]
constexpr Range kYoung{10.0, 1e10};            // [Pa], jelly to hard plastics
constexpr Range kTissueLength{1e-5, 0.1};      // [m]
constexpr std::size_t kMostTurns = 16;
constexpr double kMostGap = 0.05;              // [m]
constexpr double kMostDamping = 1e5;           // [1/s]
constexpr double kArteryPressure = 100.0 * 133.322387415;  // [Pa], that the numbers of a Circulation belong to
constexpr Range kBloodPressure{100.0, 1e5};    // [Pa], 750 mmHg
constexpr Range kFlow{1e-12, 1e-3};            // [m3/s], to a litre a second
constexpr double kMostPuncture = 10.0;         // [N]
constexpr double kMostTrackStiffness = 1e6;    // [N/m]
constexpr Range kTrackStiffness{1e-3, kMostTrackStiffness};

WallLayer read_layer(const YamlNode& node) {
  WallLayer l;
  l.name = node.text("name");
  l.thickness = node.quantity("thickness", "um", kLayerThickness);
  l.law = WallLaw::hooke(node.quantity("young", "kPa", kYoung), node.number("poisson", Range::between(0.0, 0.499)));
  node.text("source");
  return l;
}

/// A frame holds the card on all sides and covers its border: thread that runs over it meets no rim to catch on.
void frame_all_round(VesselMesh& mesh) {
  for (const WallFace& f : mesh.faces) {
    if (f.surface != WallSurface::edge) continue;
    for (const int c : f.corner) mesh.held.push_back(mesh.elements[static_cast<std::size_t>(f.element)][static_cast<std::size_t>(c)]);
  }
  std::erase_if(mesh.faces, [](const WallFace& f) { return f.surface == WallSurface::edge || f.surface == WallSurface::end; });
}

double poisson_ratio(const WallLaw& law) { return 0.5 * law.lambda / (law.lambda + law.mu); }

/// Stretched alike along x and y onto its frame: without stress it would be smaller and thicker.
void stretch_card(VesselMesh& mesh, double stretch, double poisson) {
  const double thicker = 1.0 + 2.0 * poisson / (1.0 - poisson) * (stretch - 1.0);
  for (Corners& c : mesh.stress_free) {
    c.topRows<2>() /= stretch;
    c.row(2) *= thicker;
  }
}

/// Two flaps that face each other across a straight cut along x; uncut: one alone in a frame, about the centre.
VesselMesh read_card(const YamlNode& node, double thickness, double poisson) {
  CardShape shape;
  shape.thickness = thickness;
  shape.width = node.quantity("width", "mm", kTissueLength);
  shape.depth = node.quantity("depth", "mm", kTissueLength);
  shape.across = node.integer("across", 2, 60);
  shape.deep = node.integer("deep", 2, 40);
  const Vec3 at = read_point(node, "centre");
  const VesselMesh flap = make_card(shape);
  VesselMesh mesh;
  Pose X;
  if (node.flag_or("uncut", false)) {
    X.p = at + 0.5 * shape.depth * Vec3::UnitY();
    append(mesh, flap, X);
    frame_all_round(mesh);
    stretch_card(mesh, node.number_or("stretch", 1.0, Range::between(1.0, 1.5)), poisson);
    return mesh;
  }
  const double gap = node.quantity("gap", "mm", Range::between(0.0, kMostGap));
  X.p = at - 0.5 * gap * Vec3::UnitY();
  append(mesh, flap, X);
  X.p = at + 0.5 * gap * Vec3::UnitY();
  X.q = Quat(Eigen::AngleAxisd(std::numbers::pi, Vec3::UnitZ()));
  append(mesh, flap, X);
  return mesh;
}

void read_flaps(const YamlNode& node, VesselModel& v) {
  v.name = node.text("name");
  for (const YamlNode& layer : node.items("layers")) v.layers.push_back(read_layer(layer));
  for (const WallLayer& l : v.layers) v.thickness += l.thickness;
  if (v.layers.empty()) node.refuse("layers", "at least one layer");
  v.mesh = read_card(node, v.thickness, poisson_ratio(v.layers.front().law));
  v.wall.damping = node.quantity("damping", "1/s", Range::between(0.0, kMostDamping));
}

/// The blood of a preset's own vessel: an artery's pressures, all in proportion to its own.
void scale_blood(double pressure, Circulation& c) {
  const double share = pressure / kArteryPressure;
  c.pressure *= share;
  c.back *= share;
  c.opening *= share;
}

/// What the clamps keep out; flows that are not said are an artery's.
void read_blood(const YamlNode& node, VesselModel& v) {
  Circulation& c = v.circulation;
  c.pressure = node.quantity("pressure", "mmHg", kBloodPressure);
  c.back = node.quantity("back", "mmHg", Range::between(0.0, c.pressure));
  c.opening = node.quantity("opening", "mmHg", Range::between(0.0, c.pressure));
  c.cut_flow = node.quantity_or("cut_flow", "m3/s", c.cut_flow, kFlow);
  c.through = node.quantity_or("through", "m3/s", c.through, kFlow);
  if (c.downstream() <= 0.0) node.refuse("through", "less than the cut vessel gives");
  v.slack = node.quantity_or("slack", "mmHg", 0.0, {-1e4, 0.0});
}

/// `turns:` of a double clamp: from how the mesh is made, one after the other.
std::vector<double> read_turns(const YamlNode& node) {
  const std::vector<double> turns = node.quantities("turns", "deg", Range::between(-2.0 * std::numbers::pi, 2.0 * std::numbers::pi));
  if (turns.size() < 2 || turns.size() > kMostTurns || turns[0] != 0.0) node.refuse("turns", "two to sixteen angles, the first zero: as the clamp is at the start");
  return turns;
}

double outer_radius(const TubeShape& s) { return make_tube(s).nodes.topRows<2>().colwise().norm().maxCoeff(); }  // [m], as first made

/// `side:` of a vessel: the second stump leans over an opening in the side of a whole vessel of the same preset. Angles count from the heel.
void read_side(const YamlNode& node, const TubeShape& stump, VesselModel& v) {
  SideHold hold;
  hold.lean = node.quantity("lean", "deg", Range::between(0.4, 0.5 * std::numbers::pi));
  hold.reach = 0.5 * node.quantity("length", "mm", kTissueLength);
  hold.radius = v.radius = outer_radius(stump);
  TubeShape vessel = stump;
  vessel.along = node.integer("along", 8, 200);
  SideOpening opening;
  opening.length = node.quantity("opening", "mm", Range::between(0.5 * hold.radius, 1.4 * hold.reach));
  opening.width = node.quantity("width", "mm", Range::between(0.2 * hold.radius, 2.0 * hold.radius));
  opening.across = 2 * node.integer("half_across", 1, (stump.around - 4) / 2);
  opening.along = node.integer("opening_along", 2, vessel.along - 4);
  if (2 * (opening.across + opening.along) > kMostEdgeNodes) node.refuse("opening_along", "at most 32 elements across and along the opening together");
  v.turns = {0.0, node.quantity("over", "deg", Range::between(-std::numbers::pi, std::numbers::pi))};
  v.clamp.side = hold;
  v.cut_along = v.clamp.X_WB.q * Vec3::UnitZ();
  v.mesh = make_end_to_side(vessel, opening, stump, v.clamp);
}

/// Two stumps of a preset in a double clamp, cut edges facing, the bar along y. Where x is least counts as the angle zero.
void read_stumps(const std::string& root, const YamlNode& node, const std::string& instead, Model& m, VesselModel& v) {
  const std::string named = "models/vessel/" + node.text("preset") + ".yaml", file = instead.empty() ? named : instead;
  v.name = instead.empty() ? node.text("preset") : std::filesystem::path(instead).stem().string();
  VesselPreset preset = load_vessel(instead.empty() ? root + "/" + named : instead);
  if (!preset.tube && !instead.empty()) throw InputError(instead, "kind", "card", "a vessel that is a tube");
  if (!preset.tube) node.refuse("preset", "a vessel that is a tube");
  m.sources.push_back(file);
  TubeShape& s = preset.shape;
  s.length = node.quantity("stump", "mm", kTissueLength);
  s.around = node.integer("around", 8, 64);
  s.along = node.integer("along", 2, 200);
  s.edge_grading = node.number("grading", Range::between(0.2, 5.0));
  v.layers = preset.layers;
  v.thickness = s.thickness;
  v.adventitia = v.layers.back().name == "adventitia";
  v.wall.density = preset.wall.density;
  v.wall.damping = preset.wall.damping;
  v.clamp.gap = node.quantity("gap", "mm", Range::between(0.0, kMostGap));
  v.closed_gap = node.quantity_or("closed_gap", "mm", 0.0, {-1e-3, v.clamp.gap});
  v.clamp.turn = node.quantity("turn", "deg", Range::between(-std::numbers::pi, std::numbers::pi));
  Mat3 bar;
  bar << -Vec3::UnitX(), Vec3::UnitZ(), Vec3::UnitY();
  v.clamp.X_WB = {read_point(node, "centre"), Quat(bar)};
  scale_blood(preset.pressure, v.circulation);
  if (node.has("blood")) read_blood(node.map("blood"), v);
  v.wall.tolerance = node.quantity_or("tolerance", "uN", v.wall.tolerance, {1e-8, 1e-4});
  v.lumen = true;
  v.shape = s;
  if (node.has("side")) return read_side(node.map("side"), s, v);
  if (node.has("turns")) v.turns = read_turns(node);
  v.cut_along = -Vec3::UnitX();
  v.mesh = make_stumps(s, v.clamp);
  for (Eigen::Index i = 0; i < v.mesh.nodes.cols(); ++i) {
    const Vec3 r = v.mesh.nodes.col(i) - v.clamp.X_WB.p;
    v.radius = std::max(v.radius, (r - r.y() * Vec3::UnitY()).norm());
  }
}

}  // namespace

TrackMaterial load_track(const std::string& path) {
  const YamlNode file = open_model_file(path, "filum-track/1");
  file.text("title");
  TrackMaterial m;
  for (const YamlNode& node : file.items("layers")) {
    PunctureLayer l;
    l.puncture = measured(node, "puncture", "mN", {1e-7, kMostPuncture});
    l.cutting = measured(node, "cutting", "mN", Range::between(0.0, kMostPuncture));
    l.friction = measured(node, "friction", "N/m", Range::between(0.0, kMostTrackStiffness));
    l.drag = measured(node, "drag", "N.s/m2", Range::between(0.0, 1e6));
    m.layers.push_back(l);
  }
  if (m.layers.empty()) file.refuse("layers", "at least one layer");
  m.hold = measured(file, "hold", "N/m", kTrackStiffness);
  if (file.has("stiffens")) m.stiffens = measured(file, "stiffens", "um", {1e-6, 1e-2});
  m.point_stiffness = measured(file, "point_stiffness", "N/m", kTrackStiffness);
  m.least_angle = measured(file, "least_angle", "deg", Range::between(0.0, 0.5 * std::numbers::pi));
  m.thread_share = measured(file, "thread_share", "-", Range::between(0.0, 10.0));
  m.bend_friction = measured(file, "bend_friction", "-", Range::between(0.0, 2.0));
  m.tear = measured(file, "tear", "N/m", kTrackStiffness);
  m.exit_share = measured(file, "exit_share", "-", Range::between(0.0, 1.0));
  m.wear = measured(file, "wear", "1/N", Range::between(0.0, 1e6));
  m.spacing = file.quantity("spacing", "um", Range::between(1e-6, 1e-2));
  file.finish();
  return m;
}

bool is_vessel(const std::string& path) {
  return !path.empty() && YamlNode::load(path).text_or("format", "").starts_with("filum-vessel/");
}

void read_tissue(const std::string& root, const YamlNode& node, const std::string& vessel_file, Model& m) {
  auto v = std::make_shared<VesselModel>();
  v->kind = node.choice("kind", {"card", "vessel"});
  v->wall.dt = m.step.dt;
  v->wall.strict_iterations = 5;
  v->wall.max_iterations = 16;  // a late step is made up for; a wall that is far from balance is not
  if (v->kind == "card")
    read_flaps(node, *v);
  else
    read_stumps(root, node, vessel_file, m, *v);
  const std::string file = "models/track/" + node.text("track") + ".yaml";
  m.sources.push_back(file);
  v->track = load_track(root + "/" + file);
  if (v->track.layers.size() != v->layers.size())
    node.refuse("track", "as many layers as the tissue has: " + v->name + " has " + std::to_string(v->layers.size()) + ", this track " + std::to_string(v->track.layers.size()));
  describe_tissue(*v, m.description.tissue);
  m.vessel = std::move(v);
}

}  // namespace filum
