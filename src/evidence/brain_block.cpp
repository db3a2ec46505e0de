#include "evidence/brain_block.h"

#include <chrono>
#include <cmath>
#include <numbers>

#include "evidence/timing.h"

namespace filum {
namespace {

BladeShape square(double side) {
  BladeShape b;
  b.width = b.tip_width = b.length = side;
  b.taper = 0.0;
  return b;
}

}  // namespace

TetMesh block_of_nodes(int nx, int ny, int nz, const Vec3& size) {
  return box_mesh(Vec3(-0.5 * size.x(), -0.5 * size.y(), -size.z()), Vec3(0.5 * size.x(), 0.5 * size.y(), 0.0), nx - 1, ny - 1, nz - 1);
}

BrainBlock::BrainBlock(TetMesh mesh, const FemOptions& options, double side, const SpatulaParameters& parameters, int blade_cells)
    : fem(std::move(mesh), {FemMaterial{}}, options),
      state(fem.rest()),
      blade_(blade_surface(square(side), blade_cells, blade_cells)),
      contact_(parameters),
      tree_(surface_triangles(fem.mesh()), fem.mesh().nodes),
      positions_(fem.mesh().nodes),
      seen_(state.u),
      marked_(static_cast<std::size_t>(fem.mesh().n_nodes()), 0) {
  const double lowest = fem.mesh().nodes.row(2).minCoeff();
  std::vector<int> held;
  for (int i = 0; i < fem.mesh().n_nodes(); ++i)
    if (fem.mesh().nodes(2, i) < lowest + 1e-9) held.push_back(i);
  fem.hold(held);
  const auto n = static_cast<std::size_t>(fem.mesh().n_nodes());
  contact_.reserve(n);
  contact_.set_surface(fem.mesh(), tree_.triangles());
  contacts_.reserve(n);
  hits_.reserve(tree_.triangles().size());
  candidates_.reserve(n);
  blades_[0].surface = &blade_;
  blades_[0].X_now = at(Vec3(0, 0, 1e-4));
}

Pose BrainBlock::at(const Vec3& p) const {
  Pose X;
  X.q = Quat(Eigen::AngleAxisd(0.5 * std::numbers::pi, Vec3::UnitX()));  // the blade's normal points up
  X.p = p - X.q * Vec3(0, 0, 0.5 * blade_.high.z());
  return X;
}

void BrainBlock::find_contacts(const Vec3& p) {
  blades_[0].X_before = blades_[0].X_now;
  blades_[0].X_now = at(p);
  positions_ = fem.mesh().nodes + state.u;
  tree_.refit(positions_);
  const double reach = 0.6 * blade_.high.z() * std::numbers::sqrt2 + 5e-3;
  const Vec3 low = p.cwiseMin(blades_[0].X_before * Vec3(0, 0, 0.5 * blade_.high.z())).array() - reach;
  hits_.clear();
  candidates_.clear();
  tree_.overlaps({low, p.array() + reach}, hits_);
  for (const int t : hits_)
    for (const int i : tree_.triangles()[static_cast<std::size_t>(t)]) {
      if (marked_[static_cast<std::size_t>(i)]) continue;
      marked_[static_cast<std::size_t>(i)] = 1;
      candidates_.push_back(i);
    }
  for (const int i : candidates_) marked_[static_cast<std::size_t>(i)] = 0;
  contact_.update(fem, state.u, seen_, blades_, candidates_, contacts_);
  seen_ = state.u;
}

void BrainBlock::step(const Vec3& p) {
  auto begin = Clock::now();
  find_contacts(p);
  contact_ms = milliseconds_since(begin);
  begin = Clock::now();
  summary = fem.step(state, contact_.moved());
  solve_ms = milliseconds_since(begin);
  contact_.read(fem, state.u, blades_, contacts_);
}

void BrainBlock::rest_at(const Vec3& p) {
  constexpr int kRounds = 8;
  for (int k = 0; k < kRounds; ++k) {
    find_contacts(p);
    summary = fem.equilibrium(state, contact_.moved());
    contact_.read(fem, state.u, blades_, contacts_);
  }
}

}  // namespace filum
