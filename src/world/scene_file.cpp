#include "world/scene_file.h"

#include <cmath>
#include <filesystem>

#include "base/error.h"
#include "world/brain_file.h"
#include "world/measured_model.h"
#include "world/model_file.h"
#include "world/needle_file.h"
#include "world/task_folder.h"
#include "world/vessel_file.h"
#include "world/world.h"

namespace filum {
namespace {

// What a bench under a microscope can hold, widely taken: a slip of unit or exponent is refused, no material or instrument is.
constexpr Range kBenchLength{1e-6, 1.0};        // [m]
constexpr Range kThreadDiameter{5e-6, 1e-3};    // [m], beyond 12-0 and 5
constexpr Range kThreadDensity{100.0, 25e3};    // [kg/m3], foams to tungsten
constexpr Range kThreadStretching{1e-6, 1e6};   // [N], EA
constexpr Range kThreadBending{1e-14, 1e-4};    // [N m2], EI and GJ
constexpr Range kThreadStrength{1e-4, 1e3};     // [N]
constexpr Range kStiffness{1e-2, 1e8};          // [N/m]
constexpr Range kTurningStiffness{1e-6, 1e3};   // [N m/rad]
constexpr Range kInstrumentMass{1e-4, 10.0};    // [kg]
constexpr Range kInstrumentInertia{1e-10, 1.0}; // [kg m2]
constexpr Range kGripForce{1e-4, 1e3};          // [N]
constexpr Range kPelletMass{1e-12, 1.0};        // [kg]

PostShape read_bar(const YamlNode& node) {
  PostShape bar;
  bar.p_W = read_point(node, "centre");
  bar.axis_W = read_direction(node, "axis");
  bar.radius = node.quantity("radius", "mm", kBenchLength);
  bar.half_length = 0.5 * node.quantity("length", "mm", kBenchLength);
  return bar;
}

Points read_thread_path(const YamlNode& scene, double longest, int capacity) {
  const double length = scene.quantity("length", "mm", {1e-3, 1.0});
  const Vec3 tip = read_point(scene, "short_end");
  const Vec3 direction = read_direction(scene, "direction");
  const int n = std::max(8, static_cast<int>(std::ceil(length / longest)) + 1);
  if (n > capacity) scene.refuse("length", "a thread that resolution.nodes times resolution.longest reaches along");
  Points path(3, n);
  for (int i = 0; i < n; ++i) path.col(i) = tip + direction * (length * i / (n - 1));
  return path;
}

void read_resolution(const YamlNode& node, ResolutionOptions& o, int& capacity) {
  o.shortest = node.quantity("shortest", "um", kBenchLength);
  o.longest = node.quantity("longest", "um", {o.shortest, 1.0});
  o.touching_edge = node.quantity("touching", "um", kBenchLength);
  capacity = node.integer("nodes", 16, 2000);
}

ToolShape shape_of(const InstrumentParameters& p) {
  ToolShape s;
  s.name = p.name;
  s.kind = p.kind;
  s.jaw_length = p.jaw_length;
  s.tip_radius = p.tip_radius;
  s.base_radius = p.base_radius;
  s.pad_length = p.pads.length;
  s.max_angle = p.max_angle;
  return s;
}

void read_instruments(const std::string& root, const YamlNode& scene, Model& m) {
  for (const YamlNode& item : scene.items("instruments")) {
    if (m.instruments.size() == m.description.tools.size()) item.refuse("model", "at most three instruments");
    const std::string file = "models/instrument/" + item.text("model") + ".yaml";
    m.sources.push_back(file);
    InstrumentParameters p = load_instrument(root + "/" + file);
    p.name = item.text_or("name", p.name);
    m.description.tools[m.instruments.size()] = shape_of(p);
    m.instruments.push_back(p);
    m.instrument_start.push_back(read_pose(item));
  }
  m.description.n_tools = static_cast<int>(m.instruments.size());
}

void read_pellets(const YamlNode& scene, Model& m) {
  for (const YamlNode& item : scene.items_or_none("objects")) {
    if (m.pellets.size() == m.description.pellets.size()) item.refuse("name", "at most eight objects");
    PelletParameters p;
    p.name = item.text("name");
    p.start = read_point(item, "p");
    p.radius = item.quantity("radius", "mm", kBenchLength);
    p.mass = item.quantity("mass", "mg", kPelletMass);
    p.stiffness = item.quantity("stiffness", "N/m", kStiffness);
    p.friction = item.number("friction", {0.0, 2.0, true});
    p.adhesion = item.quantity("adhesion", "mN", Range::between(0.0, kGripForce.high));
    p.strength = item.quantity("strength", "mN", kGripForce);
    item.text("source");
    m.description.pellets[m.pellets.size()] = {p.name, p.radius, p.slip_limit(), p.strength};
    m.pellets.push_back(p);
  }
  m.description.n_pellets = static_cast<int>(m.pellets.size());
}

}  // namespace

RodMaterial load_suture(const std::string& path, ContactMaterial& contact) {
  const YamlNode file = open_model_file(path, "filum-suture/1");
  file.text("title");
  RodMaterial m;
  m.radius = 0.5 * measured(file, "diameter", "um", kThreadDiameter);
  m.density = measured(file, "density", "kg/m3", kThreadDensity);
  m.EA = measured(file, "axial_stiffness", "N", kThreadStretching);
  m.EI = measured(file, "bending_stiffness", "N.m2", kThreadBending);
  m.GJ = measured(file, "twisting_stiffness", "N.m2", kThreadBending);
  m.friction = measured(file, "friction_coefficient", "-", Range::between(0.0, 2.0));
  m.strength = measured(file, "strength", "N", kThreadStrength);
  m.drag = measured(file, "air_drag", "N.s/m2", Range::between(0.0, 1.0));
  m.most_elastic_curvature = most_elastic_curvature(measured(file, "yield_strain", "-", Range::between(1e-4, 10.0)), m.radius);
  m.internal_friction = measured(file, "internal_friction", "ms", Range::between(0.0, 10.0));
  contact.stiffness = measured(file, "squeeze_stiffness", "N/m", kStiffness);
  contact.friction = m.friction;
  contact.presliding = 0.2 * m.radius;
  file.finish();
  return m;
}

InstrumentParameters load_instrument(const std::string& path) {
  const YamlNode file = open_model_file(path, "filum-instrument/1");
  InstrumentParameters p;
  p.name = file.text("title");
  p.kind = file.choice("kind", {"forceps", "needle-holder", "scissors"});
  p.jaw_length = file.quantity("jaw_length", "mm", kBenchLength);
  p.tip_radius = file.quantity("tip_radius", "mm", kBenchLength);
  p.base_radius = file.quantity("base_radius", "mm", kBenchLength);
  p.shaft_length = file.quantity("shaft_length", "mm", kBenchLength);
  p.max_angle = file.quantity("max_angle", "deg", {0.01, 1.5});
  p.mass = file.quantity("apparent_mass", "g", kInstrumentMass);
  p.inertia = file.quantity("apparent_inertia", "kg.m2", kInstrumentInertia);
  p.coupling_stiffness = file.quantity("coupling_stiffness", "N/m", kStiffness);
  p.turning_stiffness = file.quantity("turning_stiffness", "N.m/rad", kTurningStiffness);
  p.coupling_damping = 2.0 * std::sqrt(p.coupling_stiffness * p.mass);  // critical
  p.turning_damping = 2.0 * std::sqrt(p.turning_stiffness * p.inertia);
  p.grip_stiffness = file.quantity("grip_stiffness", "N.m/rad", kTurningStiffness);
  p.max_grip_force = file.quantity("max_grip_force", "N", kGripForce);
  p.pads.half_width = 0.5 * file.quantity("pad_width", "mm", kBenchLength);
  p.pads.length = file.quantity("pad_length", "mm", kBenchLength);
  p.pads.friction = file.number("pad_friction", Range::between(0.0, 2.0));
  file.text("source");
  file.finish();
  return p;
}

std::shared_ptr<const Model> load_model(const std::string& root, const std::string& task, const std::string& model_file) {
  if (task.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-") != std::string::npos || task.empty())
    throw InputError("command line", "task", task, "a task name such as knot-square (see `filum list`)");
  const std::string folder = task_folder(root, task), path = root + "/" + folder + "/scene.yaml";
  if (folder.empty()) throw InputError("command line", "task", task, "the name of a task with a scene (see `filum list`)");
  if (YamlNode::load(path).text("format") == kBrainScene) return load_brain_scene(root, task, model_file);
  auto m = std::make_shared<Model>();
  const YamlNode scene = open_model_file(path, "filum-scene/1");
  m->sources.push_back(folder + "/scene.yaml");
  SceneDescription& d = m->description;
  d.task = task;
  d.title = scene.text("title");
  const std::string suture = scene.text("suture");
  const std::string suture_file = "models/suture/" + suture + ".yaml";
  const std::string vessel_file = is_vessel(model_file) ? model_file : "";
  const bool own = model_file.empty() || !vessel_file.empty() || MeasuredModel::is_one(model_file);
  d.suture = own ? suture : std::filesystem::path(model_file).stem().string();
  m->thread = load_suture(own ? root + "/" + suture_file : model_file, m->contact);
  m->sources.push_back(own ? suture_file : model_file);
  if (own && !model_file.empty() && vessel_file.empty()) {
    MeasuredModel::load(model_file).apply_to_thread(*m);
    m->sources.push_back(model_file);
  }
  d.thread_radius = m->thread.radius;
  d.thread_strength = m->thread.strength;
  read_resolution(scene.map("resolution"), m->resolution, d.capacity);
  const YamlNode thread = scene.map("thread");
  m->thread_path = read_thread_path(thread, m->resolution.longest, d.capacity);
  if (scene.has("needle")) read_needle(root, scene.map("needle"), *m);
  m->sutures = scene.integer_or("sutures", 1, 1, 50);
  if (m->sutures > 1 && !m->needle) scene.refuse("sutures", "one, of a thread without a needle");
  d.has_post = scene.has("post") || !m->needle;
  if (d.has_post) {
    d.post = read_bar(scene.map("post"));
    d.base = read_bar(scene.map("base"));
  }
  for (const YamlNode& lip : scene.items_or_none("lips")) m->lips.push_back(read_bar(lip));
  for (const YamlNode& bar : scene.items_or_none("notch")) d.notch.push_back(read_bar(bar));
  for (const YamlNode& bar : scene.items_or_none("frame")) d.frame.push_back(read_bar(bar));
  d.floor_height = scene.quantity("floor", "mm", Range::between(-kBenchLength.high, kBenchLength.high));
  m->post_friction = scene.number("post_friction", Range::between(0.0, 2.0));
  m->jaw_friction = scene.number("jaw_friction", Range::between(0.0, 2.0));
  read_instruments(root, scene, *m);
  m->instruments_touch = scene.flag_or("instruments_touch", true);
  d.dt = m->step.dt = scene.quantity("step", "ms", {1e-4, 5e-3});
  if (scene.has("tissue") && !m->needle) scene.refuse("needle", "a needle beside the tissue");
  if (scene.has("tissue")) read_tissue(root, scene.map("tissue"), vessel_file, *m);
  if (!vessel_file.empty() && (!m->vessel || !m->vessel->lumen))
    throw InputError("command line", "--model", vessel_file, "a suture, since the task " + task + " has no vessel");
  read_pellets(scene, *m);
  d.has_field = scene.has("field");
  if (d.has_field) d.field_W = read_point(scene, "field");
  m->step.max_iterations = scene.integer("newton_iterations", 1, 100);
  m->step.strict_iterations = 6;
  m->step.longest_move = 16.0 * m->thread.radius;
  scene.finish();
  return m;
}

}  // namespace filum
