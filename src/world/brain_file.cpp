#include "world/brain_file.h"

#include <algorithm>
#include <filesystem>
#include <limits>

#include "base/error.h"
#include "world/describe.h"
#include "world/measured_model.h"
#include "world/model_file.h"
#include "world/task_folder.h"

namespace filum {
namespace {

// A head and what is laid on it, widely taken: a slip of unit or exponent is refused, no tissue or blade is.
constexpr double kHead = 0.5;                  // [m]
constexpr Range kHeadLength{1e-5, kHead};      // [m]
constexpr Range kUpToHead{0.0, kHead};         // [m]
constexpr Range kHeight{-kHead, kHead};        // [m]
constexpr Range kYoung{1.0, 1e8};              // [Pa]
constexpr Range kDensity{100.0, 1e4};          // [kg/m3]
constexpr Range kVeinStiffness{1e-3, 1e5};     // [N/m]
constexpr Range kVeinStrength{1e-4, 100.0};    // [N]

CortexShape read_shape(const YamlNode& node) {
  CortexShape s;
  s.size = read_point(node, "size");
  const YamlNode cells = node.map("cells");
  s.cells = {cells.integer("along", 2, 100), cells.integer("across", 2, 100), cells.integer("deep", 2, 100)};
  s.gyrus = node.quantity("gyrus", "mm", kHeadLength);
  s.sulcus = node.quantity("sulcus", "mm", kUpToHead);
  s.grey = node.quantity("grey", "mm", kUpToHead);
  s.fissure_depth = node.quantity_or("fissure_depth", "mm", 0.0, kUpToHead);
  s.fissure_gap = node.quantity_or("fissure_gap", "mm", 1e-3, kHeadLength);
  s.open_side = node.flag_or("open_side", false);
  s.lean = node.quantity_or("lean", "mm", 0.0, kUpToHead);
  s.fissure_wave = node.quantity_or("fissure_wave", "mm", 0.0, kUpToHead);
  return s;
}

FemMaterial read_tissue(const YamlNode& node) {
  FemMaterial m;
  m.young = measured(node, "young", "kPa", kYoung);
  m.poisson = measured(node, "poisson", "-", {-0.99, 0.4999, false});
  m.density = measured(node, "density", "kg/m3", kDensity);
  return m;
}

void read_veins(const YamlNode& file, BrainModel& m) {
  for (const YamlNode& item : file.items_or_none("veins")) {
    BridgingVein v;
    const Vec3 at = read_point(item, "cortex");
    v.dura_W = read_point(item, "dura");
    double nearest = 1.0;
    v.node = -1;
    for (const int i : m.cortex.surface_nodes) {
      const double d = (m.cortex.mesh.nodes.col(i) - at).norm();
      const bool held = std::binary_search(m.cortex.held.begin(), m.cortex.held.end(), i);
      if (held || d >= nearest) continue;
      nearest = d;
      v.node = i;
    }
    if (v.node < 0) item.refuse("cortex", "a place on the free surface, within 1 m of it");
    v.slack = (v.dura_W - Vec3(m.cortex.mesh.nodes.col(v.node))).norm() * item.number("slack", Range::between(1.0, 3.0));
    v.stiffness = item.quantity("stiffness", "N/m", kVeinStiffness);
    v.strength = item.quantity("strength", "N", kVeinStrength);
    item.text("source");
    const bool twice = std::any_of(m.veins.begin(), m.veins.end(), [&](const BridgingVein& o) { return o.node == v.node; });
    if (twice) item.refuse("cortex", "a place of its own");
    m.veins.push_back(v);
  }
}

void read_brain(const std::string& path, BrainModel& m) {
  const YamlNode file = open_model_file(path, "filum-brain/1");
  m.name = file.text("title");
  if (file.has("mesh")) {
    m.mesh_name = file.text("mesh");
    if (m.mesh_name.find('/') != std::string::npos || m.mesh_name.find("..") != std::string::npos) file.refuse("mesh", "a file beside this one");
    m.mesh_file = (std::filesystem::path(path).parent_path() / m.mesh_name).string();
    m.cortex = cortex_from_mesh(load_mesh(m.mesh_file), file.quantity("held_below", "mm", kHeight),
                                file.quantity_or("held_beyond", "mm", std::numeric_limits<double>::infinity(), kHeadLength));
  } else {
    m.cortex = make_cortex(read_shape(file.map("shape")), path);
  }
  const double dial = file.number_or("stiffness_dial", 1.0, Range::between(0.1, 10.0));
  m.bone_y = m.cortex.bone_y;
  m.fem.averaged_pressure = file.flag_or("averaged_pressure", false);
  m.regions = {read_tissue(file.map("grey")), read_tissue(file.map("white"))};
  for (FemMaterial& tissue : m.regions) tissue.young *= dial;
  if (file.has("falx")) {
    const YamlNode falx = file.map("falx");
    m.falx.y = falx.quantity("y", "mm", kHeight);
    m.falx.bottom = falx.quantity("bottom", "mm", kHeight);
    m.falx.top = falx.quantity("top", "mm", kHeight);
    if (!m.falx.present()) falx.refuse("top", "a height above the bottom");
    falx.text("source");
  }
  m.fem.mass_damping = measured(file, "mass_damping", "1/s", Range::between(0.0, 1e5));
  m.fem.stiffness_damping = measured(file, "stiffness_damping", "ms", Range::between(0.0, 10.0));
  const RelaxationTerm term{measured(file, "relaxing_share", "-", Range::between(0.0, 0.99)), measured(file, "relaxation_time", "s", {1e-4, 1e5})};
  if (term.share > 0.0) m.fem.relaxation = {term};
  m.contact.friction = measured(file, "friction", "-", Range::between(0.0, 2.0));
  m.contact.reach = file.quantity("reach", "mm", {1e-5, 0.1});
  read_veins(file, m);
  file.finish();
}

/// Keys of a blade that somebody else puts on its arm; the first is where it starts.
std::vector<PlacedKey> read_placed(const YamlNode& blade, const Pose& start) {
  std::vector<PlacedKey> keys;
  for (const YamlNode& item : blade.items_or_none("placed")) {
    if (keys.empty()) keys.push_back({0.0, start});
    keys.push_back({item.quantity("t", "s", Range::between(keys.back().t + 1e-3, 600.0)), read_pose(item)});
  }
  return keys;
}

/// The blade as it starts and what it can be changed for.
std::vector<BladeShape> read_forms(const std::string& root, const YamlNode& blade, Model& m) {
  std::vector<std::string> names = {blade.text("model")};
  if (blade.has("others"))
    for (const std::string& other : blade.texts("others")) names.push_back(other);
  std::vector<BladeShape> forms;
  for (const std::string& name : names) {
    const char* const key = forms.empty() ? "model" : "others";
    if (name.find('/') != std::string::npos || name.find("..") != std::string::npos) blade.refuse(key, "names of files in models/spatula");
    const std::string file = "models/spatula/" + name + ".yaml";
    if (std::find(m.sources.begin(), m.sources.end(), file) == m.sources.end()) m.sources.push_back(file);
    forms.push_back(load_blade(root + "/" + file));
  }
  return forms;
}

void read_blades(const std::string& root, const YamlNode& scene, Model& m, BrainModel& brain) {
  for (const YamlNode& item : scene.items("blades")) {
    if (brain.blades.size() == 2) item.refuse("model", "at most two blades");
    const std::vector<BladeShape> forms = read_forms(root, item, m);
    const BladeShape& shape = forms.front();
    if (!brain.blades.empty() && forms.size() != brain.blades.front().size()) item.refuse("others", "as many as the first blade has");
    brain.blade_names.push_back(item.text_or("name", shape.name));
    ToolShape& tool = m.description.tools[brain.blades.size()];
    tool.name = brain.blade_names.back();
    tool.kind = "spatula";
    tool.jaw_length = shape.length;
    tool.tip_radius = 0.5 * shape.tip_width;
    tool.base_radius = 0.5 * shape.width;
    brain.blades.push_back(forms);
    brain.blade_start.push_back(read_pose(item));
    brain.arm_keeps_force.push_back(item.has("arm") && item.choice("arm", {"pose", "force"}) == "force");
    brain.placed.push_back(read_placed(item, brain.blade_start.back()));
  }
  if (brain.blades.empty()) scene.refuse("blades", "one or two blades");
  m.description.n_tools = static_cast<int>(brain.blades.size());
}

}  // namespace

BladeShape load_blade(const std::string& path) {
  const YamlNode file = open_model_file(path, "filum-spatula/1");
  BladeShape b;
  b.name = file.text("title");
  b.width = file.quantity("width", "mm", kHeadLength);
  b.tip_width = file.quantity("tip_width", "mm", kHeadLength);
  b.taper = file.quantity("taper", "mm", kUpToHead);
  b.length = file.quantity("length", "mm", kHeadLength);
  b.grip = file.quantity("grip", "mm", kHeadLength);
  for (const YamlNode& bend : file.items_or_none("bends"))
    b.bends.push_back({bend.quantity("at", "mm", kUpToHead), bend.quantity("angle", "deg", Range::between(-3.2, 3.2)), bend.quantity("over", "mm", kHeadLength)});
  file.text("source");
  file.finish();
  check_blade(b, path);
  return b;
}

std::shared_ptr<const Model> load_brain_scene(const std::string& root, const std::string& task, const std::string& model_file) {
  const std::string scene_file = task_folder(root, task) + "/scene.yaml";
  const YamlNode scene = open_model_file(root + "/" + scene_file, kBrainScene);
  auto m = std::make_shared<Model>();
  auto brain = std::make_shared<BrainModel>();
  m->sources.push_back(scene_file);
  SceneDescription& d = m->description;
  d.task = task;
  d.title = scene.text("title");
  const std::string named = "models/brain/" + scene.text("brain") + ".yaml";
  d.suture = "none";
  const bool own = model_file.empty() || MeasuredModel::is_one(model_file);
  m->sources.push_back(own ? named : model_file);
  read_brain(own ? root + "/" + named : model_file, *brain);
  if (!scene.flag_or("relaxation", true)) brain->fem.relaxation.clear();
  brain->section_x = scene.quantity_or("section", "mm", 0.0, kHeight);
  brain->time_compression = scene.number_or("time_compression", 1.0, Range::between(1.0, 60.0));
  if (scene.has("target")) {
    const YamlNode target = scene.map("target");
    brain->target_W = read_point(target, "p");
    brain->target_radius = target.quantity("radius", "mm", kHeadLength);
  }
  read_blades(root, scene, *m, *brain);
  d.dt = m->step.dt = brain->fem.dt = scene.quantity("step", "ms", {5e-4, 2e-2});
  if (own && !model_file.empty()) {
    MeasuredModel::load(model_file).apply(*brain, d.dt, brain->time_compression);
    m->sources.push_back(model_file);
  }
  brain->fem.single_precision = true;
  brain->fem.solver.relative = scene.number_or("residual", 1e-3, Range::between(1e-12, 1e-2));
  brain->fem.solver.absolute = 20e-6;  // [N]: tissue that nobody holds needs no more
  brain->fem.solver.max_iterations = scene.integer_or("iterations", 60, 1, 10000);
  scene.finish();
  d.capacity = 8;  // of the thread that is not there
  d.floor_height = -0.1;
  describe_brain(*brain, d.brain);
  m->brain = std::move(brain);
  return m;
}

}  // namespace filum
