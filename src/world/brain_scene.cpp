#include "world/brain_scene.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/hash.h"
#include "world/blade_arm.h"
#include "world/describe.h"
#include "world/observe.h"

namespace filum {
namespace {

constexpr double kTip = 5e-3;      // [m] from the tip's edge that count as the tip
constexpr double kMargin = 1e-3;   // [m], that tissue may move in a step
constexpr double kClear = 2e-3;    // [m], distance from the tissue at which a blade may be given another form
constexpr int kSights = 19;        // lines of sight to the target
constexpr int kLookEvery = 10;     // steps between two looks at the target

/// Points spread evenly over the unit disc (sunflower).
Vec3 sight(int k) noexcept {
  const double r = std::sqrt((k + 0.5) / kSights), a = k * std::numbers::pi * (3.0 - std::sqrt(5.0));
  return {r * std::cos(a), r * std::sin(a), 0.0};
}

/// Does the vertical line through p pass through the triangle above p?
bool covers(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p) noexcept {
  const auto cross = [](const Vec3& u, const Vec3& v, const Vec3& w) { return (v.x() - u.x()) * (w.y() - u.y()) - (v.y() - u.y()) * (w.x() - u.x()); };
  const double whole = cross(a, b, c), wa = cross(p, b, c), wb = cross(a, p, c), wc = cross(a, b, p);
  if (whole == 0.0 || wa * whole < 0.0 || wb * whole < 0.0 || wc * whole < 0.0) return false;
  return (wa * a.z() + wb * b.z() + wc * c.z()) / whole > p.z() + 1e-6;
}

FemOptions compressed(FemOptions o, double factor) {
  for (RelaxationTerm& t : o.relaxation) t.time /= factor;
  return o;
}

}  // namespace

BrainScene::BrainScene(std::shared_ptr<const BrainModel> model)
    : model_(std::move(model)),
      fem_(model_->cortex.mesh, model_->regions, compressed(model_->fem, model_->time_compression), model_->name),
      contact_(model_->contact),
      tree_(model_->cortex.surface, model_->cortex.mesh.nodes),
      section_(cut_mesh(model_->cortex.mesh, model_->section_x)),
      falx_(model_->falx, model_->cortex.mesh, model_->cortex.surface_nodes, model_->cortex.held) {
  fem_.hold(model_->cortex.held);
  const auto n = static_cast<std::size_t>(model_->cortex.mesh.n_nodes());
  vertex_of_.assign(n, -1);
  marked_.assign(n, 0);
  for (std::size_t k = 0; k < model_->cortex.surface_nodes.size(); ++k) vertex_of_[static_cast<std::size_t>(model_->cortex.surface_nodes[k])] = static_cast<int>(k);
  area_.assign(model_->cortex.surface_nodes.size(), 0.0);
  hits_.reserve(model_->cortex.surface.size());
  candidates_.reserve(n);
  contact_.reserve(n + falx_.size());
  contact_.set_surface(model_->cortex.mesh, model_->cortex.surface);
  for (const auto& forms : model_->blades) {
    surfaces_.emplace_back();
    for (const BladeShape& shape : forms) surfaces_.back().push_back(surface_of_shape(shape));
  }
  blades_.resize(surfaces_.size());
  for (std::size_t i = 0; i < surfaces_.size(); ++i) {
    blades_[i].surface = &surfaces_[i].front();
    blades_[i].X_now = blades_[i].X_before = model_->blade_start[i];
  }
  positions_ = model_->cortex.mesh.nodes;
  loads_ = Points::Zero(3, model_->cortex.mesh.n_nodes());
  response_.assign(3 * blades_.size(), Columns4::Zero(4, model_->cortex.mesh.n_nodes()));
  stiffness_.assign(blades_.size(), Mat3::Zero());
  probes_.reserve(n + falx_.size());
  fem_.prepare_response();
  if (!model_->law.linear()) law_.emplace(model_->cortex.mesh, model_->regions, model_->law);
  if (model_->drainage.diffusivity > 0.0) pores_.emplace(model_->cortex.mesh, model_->regions, model_->drainage, model_->name);
  push_ = loads_;
  open_.assign(n, 0);
}

BrainState BrainScene::start() const {
  BrainState s;
  s.fem = fem_.rest();
  if (law_) s.memory = law_->start();
  if (pores_) s.content = Eigen::VectorXd::Zero(s.fem.u.cols());
  if (law_ || pores_) s.relaxed_push = s.fem.w;
  s.seen = s.fem.u;
  s.contacts.reserve(model_->cortex.surface_nodes.size());
  for (std::size_t i = 0; i < blades_.size(); ++i) {
    s.blades.emplace_back();
    s.blades.back().X_W = s.blades.back().X_WD = model_->blade_start[i];
    s.blades.back().parked = model_->placed[i].empty() ? 0 : 2;
  }
  s.torn.assign(model_->veins.size(), 0);
  return s;
}

void BrainScene::step(const Inputs& inputs, BrainState& s, std::array<std::int32_t, 3>& valid, Observation& o) noexcept {
  move_blades(inputs, s, valid, o);
  find_candidates(s);
  contact_.update(fem_, s.fem.u, s.seen, blades_, candidates_, s.contacts);
  falx_.append(fem_, s.fem.u, contact_.moved());
  const bool pushed = law_ || pores_;
  if (pushed) loads_.setZero();
  pull_veins(s, o);
  if (pushed) push_tissue(s);
  s.seen = s.fem.u;
  summary_ = fem_.step(s.fem, contact_.moved(), &loads_);
  if (!summary_.sound) say(o, "solver-trouble", -1, summary_.residual, "N");
  if (law_) law_->remember(s.fem.u, s.memory);
  contact_.read(fem_, s.fem.u, blades_, s.contacts);
  feel(s, o.step);
  report(s, o);
  if (o.step % kLookEvery == 0) s.exposed = exposed_share(s);
}

/// What the elements' law and the fluid add, relaxing as the elastic force does.
void BrainScene::push_tissue(BrainState& s) noexcept {
  const FemOptions& o = fem_.options();
  push_.setZero();
  if (law_) law_->push(s.fem.u, s.memory, s.fem.removed, push_);
  if (pores_) {
    for (const int i : model_->cortex.surface_nodes) open_[static_cast<std::size_t>(i)] = 1;
    for (const BladeContact& c : s.contacts) open_[static_cast<std::size_t>(c.node)] = 0;
    pores_->step(s.fem.u, open_, o.dt * model_->time_compression, s.content, push_);
  }
  loads_ += push_;
  for (std::size_t k = 0; k < o.relaxation.size(); ++k) {
    auto relaxed = s.relaxed_push.middleCols(static_cast<Eigen::Index>(k) * push_.cols(), push_.cols());
    relaxed += (1.0 - std::exp(-o.dt / o.relaxation[k].time)) * (push_ - relaxed);
    loads_ -= o.relaxation[k].share * relaxed;
  }
}

void BrainScene::move_blades(const Inputs& inputs, BrainState& s, std::array<std::int32_t, 3>& valid, Observation& o) noexcept {
  const double dt = fem_.options().dt;
  for (std::size_t i = 0; i < blades_.size(); ++i) {
    blades_[i].X_before = s.blades[i].X_W;
    BladeState& blade = s.blades[i];
    move_blade(*model_, i, inputs.tools[i], o.time, dt, blade, valid[i], o);
    if (asks_for_form(*model_, i, inputs.tools[i], o.time, blade)) change_form(i, s, o);
    const Pose wanted = blade.X_W;
    blade.X_W = beside_falx(model_->falx, surface_of(i, blade), blades_[i].X_before, wanted);
    const double beyond = blade.X_W.p.y() == wanted.p.y() ? 0.0 : blade.X_W.p.y() - (blade.X_WD * blade.X_DB).p.y();  // of the hand
    blade.stop_force = std::clamp(kFalxHold * beyond, -kFalxStrongest, kFalxStrongest) * Vec3::UnitY();
    blades_[i].surface = &surface_of(i, blade);
    blades_[i].X_now = blade.X_W;
  }
}

/// The next form, if the blade is in the hand and it and the new form are clear of the tissue.
void BrainScene::change_form(std::size_t i, BrainState& s, Observation& o) noexcept {
  BladeState& blade = s.blades[i];
  const std::size_t next = (static_cast<std::size_t>(blade.form) + 1) % surfaces_[i].size();
  const bool free = blade.parked == 0 && std::none_of(s.contacts.begin(), s.contacts.end(), [&](const BladeContact& c) { return c.blade == static_cast<std::int32_t>(i); });
  if (free && clear_of_tissue(s, i, surfaces_[i][next])) {
    blade.form = static_cast<std::int32_t>(next);
    say(o, "blade-changed", static_cast<int>(i), static_cast<double>(next), "-");
  } else {
    say(o, "blade-change-refused", static_cast<int>(i), blade.parked != 0 ? 1.0 : 0.0, "-");
  }
}

/// No node of the surface within kClear of the boxes, in the blade's frame, of the form it has and of the one it is to have.
bool BrainScene::clear_of_tissue(const BrainState& s, std::size_t i, const RigidSurface& form) const noexcept {
  const BladeState& blade = s.blades[i];
  const RigidSurface& now = surface_of(i, blade);
  const Vec3 low = now.low.cwiseMin(form.low).array() - kClear, high = now.high.cwiseMax(form.high).array() + kClear;
  const Pose back = blade.X_W.inverse();
  return std::none_of(model_->cortex.surface_nodes.begin(), model_->cortex.surface_nodes.end(), [&](int node) {
    const Vec3 q = back * place(s, node);
    return (q.array() > low.array()).all() && (q.array() < high.array()).all();
  });
}

/// Nodes of the triangles near the space each blade swept.
void BrainScene::find_candidates(const BrainState& s) noexcept {
  positions_ = model_->cortex.mesh.nodes + s.fem.u;
  tree_.refit(positions_);
  candidates_.clear();
  const double reach = model_->contact.reach + kMargin;
  for (const MovingBlade& b : blades_) {
    Box box{b.X_now.p, b.X_now.p};
    for (int k = 0; k < b.surface->vertices.cols(); ++k)
      for (const Pose* X : {&b.X_before, &b.X_now}) {
        const Vec3 x = *X * Vec3(b.surface->vertices.col(k));
        box.low = box.low.cwiseMin(x);
        box.high = box.high.cwiseMax(x);
      }
    box.low.array() -= reach;
    box.high.array() += reach;
    hits_.clear();
    tree_.overlaps(box, hits_);
    for (const int t : hits_)
      for (const int i : tree_.triangles()[static_cast<std::size_t>(t)])
        if (!marked_[static_cast<std::size_t>(i)]) {
          marked_[static_cast<std::size_t>(i)] = 1;
          candidates_.push_back(i);
        }
  }
  for (const int i : candidates_) marked_[static_cast<std::size_t>(i)] = 0;
}

void BrainScene::pull_veins(BrainState& s, Observation& o) noexcept {
  for (std::size_t k = 0; k < model_->veins.size(); ++k) {
    const BridgingVein& v = model_->veins[k];
    loads_.col(v.node).setZero();
    if (s.torn[k] != 0) continue;
    const Vec3 span = v.dura_W - place(s, v.node);
    const double length = span.norm(), force = v.stiffness * std::max(0.0, length - v.slack);
    if (force > v.strength) {
      s.torn[k] = 1;
      say(o, "vein-torn", -1, force, "N");
    } else if (force > 0.0) {
      loads_.col(v.node) = span * (force / length);
    }
  }
}

/// One column of one blade's stiffness a step: the force that answers a unit translation, found from the one found last.
void BrainScene::feel(const BrainState& s, std::uint64_t step) noexcept {
  const std::size_t column = static_cast<std::size_t>(step) % response_.size(), blade = column / 3;
  const int axis = static_cast<int>(column % 3);
  probes_ = contact_.moved();
  bool touched = false;
  for (std::size_t k = 0; k < probes_.size(); ++k) {
    const bool own = k < s.contacts.size() && s.contacts[k].blade == static_cast<std::int32_t>(blade);
    touched = touched || (own && s.contacts[k].normal_force > 0.0);
    probes_[k].target = own ? Vec3(Vec3::Unit(axis)) : Vec3(Vec3::Zero());
  }
  if (!touched) {
    stiffness_[blade].setZero();
    return;
  }
  fem_.respond(probes_, response_[column]);
  Vec3 force = Vec3::Zero();
  for (std::size_t k = 0; k < s.contacts.size(); ++k)
    if (s.contacts[k].blade == static_cast<std::int32_t>(blade)) force += probes_[k].force;
  stiffness_[blade].col(axis) = force;
}

/// Slips, cuts by the edge, and forces beyond what a device is given.
void BrainScene::report(BrainState& s, Observation& o) noexcept {
  measure(s, o);
  for (std::size_t i = 0; i < blades_.size(); ++i) {
    BladeState& blade = s.blades[i];
    double sliding = 0.0, edge = 0.0;
    for (const BladeContact& c : s.contacts) {
      if (c.blade != static_cast<std::int32_t>(i)) continue;
      const Vec3 q = blades_[i].X_now.inverse() * place(s, c.node);
      const Vec3 moved = blades_[i].X_now * q - blades_[i].X_before * q - fem_.options().dt * s.fem.v.col(c.node);
      const Vec3 n = blades_[i].X_now.q * surface_of(i, blade).normals[static_cast<std::size_t>(c.triangle)];
      if (c.slipping != 0 && c.share == 1.0) sliding = std::max(sliding, (moved - moved.dot(n) * n).norm());
      if (c.share < 1.0) edge = std::max(edge, o.brain.pressure[static_cast<std::size_t>(vertex_of_[static_cast<std::size_t>(c.node)])]);
    }
    blade.slid = sliding > 0.0 ? blade.slid + sliding : 0.0;
    if (blade.slid > model_->slip_distance) {
      say(o, "slip", static_cast<int>(i), blade.slid, "m");
      blade.slid = 0.0;
    }
    if (edge > model_->edge_pressure && blade.cutting == 0) say(o, "edge-cut", static_cast<int>(i), edge, "Pa");
    blade.cutting = edge > (blade.cutting != 0 ? 0.8 : 1.0) * model_->edge_pressure ? 1 : 0;
    const double force = blades_[i].force.norm(), share = force > model_->strongest ? model_->strongest / force : 1.0;
    if (share < 1.0 && blade.force.norm() < 0.999 * model_->strongest) say(o, "force-limit", static_cast<int>(i), force, "N");
    blade.force = share * blades_[i].force;
    blade.torque = share * blades_[i].torque;
  }
}

void BrainScene::measure(const BrainState& s, Observation& o) noexcept {
  BrainObservation& b = o.brain;
  std::fill(area_.begin(), area_.end(), 0.0);
  for (const Triangle& t : model_->cortex.surface) {
    const Vec3 p = place(s, t[0]);
    const double third = (place(s, t[1]) - p).cross(place(s, t[2]) - p).norm() / 6.0;
    for (const int i : t) area_[static_cast<std::size_t>(vertex_of_[static_cast<std::size_t>(i)])] += third;
  }
  std::fill(b.pressure.begin(), b.pressure.end(), 0.0);
  for (std::size_t i = 0; i < blades_.size(); ++i) b.blades[i] = BladeObservation{};
  std::array<double, 2> total{}, touched{};  // [N], [m2]
  for (const BladeContact& c : s.contacts) {
    const auto v = static_cast<std::size_t>(vertex_of_[static_cast<std::size_t>(c.node)]);
    const auto i = static_cast<std::size_t>(c.blade);
    BladeObservation& blade = b.blades[i];
    const double pressure = c.normal_force / std::max(area_[v], 1e-12);
    b.pressure[v] = pressure;
    ++blade.contacts;
    blade.peak = std::max(blade.peak, pressure);
    const double along = (s.blades[i].X_W.inverse() * place(s, c.node)).z();
    if (along < kTip) blade.tip = std::max(blade.tip, pressure);
    double& bin = blade.profile[static_cast<std::size_t>(std::clamp(static_cast<int>(along / kProfileBin), 0, kProfileBins - 1))];
    bin = std::max(bin, pressure);
    blade.area += c.share * area_[v];
    total[i] += c.normal_force;
    touched[i] += area_[v];
  }
  for (std::size_t i = 0; i < blades_.size(); ++i) b.blades[i].mean = touched[i] > 0.0 ? total[i] / touched[i] : 0.0;
}

double BrainScene::exposed_share(const BrainState& s) noexcept {
  if (model_->target_radius <= 0.0) return 0.0;
  positions_ = model_->cortex.mesh.nodes + s.fem.u;
  int seen = 0;
  for (int k = 0; k < kSights; ++k) {
    const Vec3 p = model_->target_W + model_->target_radius * sight(k);
    hits_.clear();
    tree_.overlaps({p, p + Vec3(0, 0, 1.0)}, hits_);
    const bool hidden = std::any_of(hits_.begin(), hits_.end(), [&](int t) {
      const Triangle& c = tree_.triangles()[static_cast<std::size_t>(t)];
      return covers(positions_.col(c[0]), positions_.col(c[1]), positions_.col(c[2]), p);
    });
    seen += hidden ? 0 : 1;
  }
  return double(seen) / kSights;
}

void BrainScene::observe(const BrainState& s, const std::array<std::int32_t, 3>& valid, Observation& o) noexcept {
  const double dt = fem_.options().dt;
  measure(s, o);
  for (std::size_t k = 0; k < model_->cortex.surface_nodes.size(); ++k) o.brain.positions.col(static_cast<Eigen::Index>(k)) = place(s, model_->cortex.surface_nodes[k]);
  o.n_tools = static_cast<int>(s.blades.size());
  for (std::size_t i = 0; i < s.blades.size(); ++i) {
    const BladeState& blade = s.blades[i];
    ToolObservation& tool = o.tools[i];
    tool.v_W = (blade.X_W.p - blades_[i].X_before.p) / dt;
    tool.X_WT = blade.X_W;
    tool.X_WD = blade.X_WD;
    tool.f_T_W = blade.force + blade.stop_force;
    tool.input_valid = valid[i] == kInputLive;
    tool.grasped_edge = blade.form;  // a spatula has no jaws: which of its forms it has
    BladeObservation& b = o.brain.blades[i];
    b.force_W = blade.force;
    b.torque_W = blade.torque;
    const PivotForce pivot = pivot_force(blade.X_W.p, blade.X_W * Vec3(0, 0, model_->blades[i][static_cast<std::size_t>(blade.form)].grip), blade.force, blade.torque);
    b.push_W = pivot.push;
    b.turn_W = pivot.turn;
    b.parked = blade.parked != 0;
    b.keeps_force = b.parked && model_->arm_keeps_force[i];
    b.stiffness_W = 0.5 * (stiffness_[i] + stiffness_[i].transpose());
  }
  observe_section(s, o.brain);
  o.brain.exposed = s.exposed;
  o.brain.veins_torn = 0;
  for (std::size_t k = 0; k < s.torn.size(); ++k) o.brain.veins_torn += o.brain.vein_torn[k] = s.torn[k];
  o.brain.iterations = summary_.iterations;
  o.brain.residual = summary_.residual;
}

void BrainScene::observe_section(const BrainState& s, BrainObservation& b) noexcept {
  positions_ = model_->cortex.mesh.nodes + s.fem.u;
  for (std::size_t k = 0; k < section_.corners.size(); ++k) b.section.col(static_cast<Eigen::Index>(k)) = corner_place(section_.corners[k], positions_);
  for (std::size_t k = 0; k < section_.triangles.size(); ++k) {
    const bool out = s.fem.removed[static_cast<std::size_t>(section_.element[k])] != 0;
    b.section_stress[k] = out ? 0.0 : von_mises(fem_.relaxed_stress(s.fem, section_.element[k]));
  }
}

void BrainScene::size_observation(Observation& o) const {
  BrainObservation& b = o.brain;
  b.n = static_cast<int>(model_->cortex.surface_nodes.size());
  b.positions = Points::Zero(3, b.n);
  b.pressure.assign(static_cast<std::size_t>(b.n), 0.0);
  b.n_blades = static_cast<int>(blades_.size());
  b.vein_torn.assign(model_->veins.size(), 0);
  b.section = Points::Zero(3, static_cast<Eigen::Index>(section_.corners.size()));
  b.section_stress.assign(section_.triangles.size(), 0.0);
}

void BrainScene::match(const BrainState& s) {
  fem_.match(s.fem);
  for (std::size_t i = 0; i < blades_.size(); ++i) {
    blades_[i].X_before = blades_[i].X_now = s.blades[i].X_W;
    blades_[i].surface = &surface_of(i, s.blades[i]);
  }
}

std::array<std::pair<const char*, std::uint64_t>, 8> brain_hashes(const BrainState& s) noexcept {
  const auto points = [](const Points& p) { return hash_bytes(p.data(), sizeof(double) * static_cast<std::size_t>(p.size())); };
  std::uint64_t contacts = s.contacts.size(), blades = s.blades.size();
  for (const BladeContact& c : s.contacts) {
    const std::array<double, 13> row = {double(c.node), double(c.blade), double(c.triangle), double(c.side), c.normal_force, c.share, double(c.slipping),
                                        c.friction.x(), c.friction.y(), c.friction.z(), c.anchor_T.x(), c.anchor_T.y(), c.anchor_T.z()};
    contacts = hash_bytes(row.data(), sizeof row, contacts);
  }
  for (const BladeState& b : s.blades) {
    for (const Vec3* v : {&b.X_W.p, &b.X_WD.p, &b.X_DB.p, &b.force, &b.torque, &b.kept_force, &b.stop_force}) blades = hash_bytes(v->data(), 3 * sizeof(double), blades);
    for (const Quat* q : {&b.X_W.q, &b.X_WD.q, &b.X_DB.q}) blades = hash_bytes(q->coeffs().data(), 4 * sizeof(double), blades);
    const std::array<double, 6> row = {b.slid, double(b.parked), double(b.toggling), double(b.cutting), double(b.form), double(b.choosing)};
    blades = hash_bytes(row.data(), sizeof row, blades);
  }
  std::uint64_t rest = hash_bytes(&s.exposed, sizeof s.exposed, hash_bytes(s.torn.data(), s.torn.size() * sizeof(std::int32_t)));
  rest = hash_bytes(s.fem.removed.data(), s.fem.removed.size(), rest);
  const auto chain = [](const auto& m, std::uint64_t h) { return m.size() == 0 ? h : hash_bytes(m.data(), sizeof(double) * static_cast<std::size_t>(m.size()), h); };
  const std::uint64_t relaxed = chain(s.relaxed_push, chain(s.content, chain(s.memory.top, chain(s.memory.peak, points(s.fem.w)))));
  return {{{"brain_displacement", points(s.fem.u)}, {"brain_velocity", points(s.fem.v)}, {"brain_acceleration", points(s.fem.a)},
           {"brain_relaxed", relaxed},      {"brain_seen", points(s.seen)},      {"brain_contacts", contacts},
           {"brain_blades", blades},                {"brain_flags", rest}}};
}

}  // namespace filum
