#include "physics/linear_fem.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace filum {
namespace {

struct Lame {
  double lambda, mu;
};
Lame lame(const FemMaterial& m) {
  const double mu = m.young / (2.0 * (1.0 + m.poisson));
  return {m.young * m.poisson / ((1.0 + m.poisson) * (1.0 - 2.0 * m.poisson)), mu};
}

using Corners = Eigen::Matrix<double, 3, 4>;

/// Of the displacements d [m] of an element's corners.
Mat3 stress_of(const Corners& b, const Corners& d, const Lame& l) {
  const Mat3 gradient = d * b.transpose(), strain = 0.5 * (gradient + gradient.transpose());
  return l.lambda * strain.trace() * Mat3::Identity() + 2.0 * l.mu * strain;
}

/// Nodes each node shares an element with; two rings of them where pressures are averaged.
std::vector<std::vector<int>> neighbours(const TetMesh& m, bool two_rings) {
  std::vector<std::vector<int>> near(static_cast<std::size_t>(m.n_nodes()));
  for (const Tetrahedron& t : m.tets)
    for (const int i : t) near[static_cast<std::size_t>(i)].insert(near[static_cast<std::size_t>(i)].end(), t.begin(), t.end());
  const auto tidy = [](std::vector<int>& list) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  };
  for (auto& list : near) tidy(list);
  if (!two_rings) return near;
  auto far = near;
  for (auto& list : far) {
    const std::vector<int> first = list;
    for (const int j : first) list.insert(list.end(), near[static_cast<std::size_t>(j)].begin(), near[static_cast<std::size_t>(j)].end());
    tidy(list);
  }
  return far;
}

void check_relaxation(const std::vector<RelaxationTerm>& terms, const std::string& file) {
  double sum = 0.0;
  for (const RelaxationTerm& t : terms) {
    sum += t.share;
    if (!(t.share > 0.0 && sum < 1.0)) throw InputError(file, "relaxing share", std::to_string(t.share), "shares above 0 that sum to less than 1");
    if (!(t.time > 0.0)) throw InputError(file, "relaxation time", std::to_string(t.time), "a time above 0 s");
  }
}

}  // namespace

void check_material(const FemMaterial& m, const std::string& file) {
  if (!(std::isfinite(m.young) && m.young > 0.0)) throw InputError(file, "young", std::to_string(m.young), "a modulus above 0 Pa");
  if (!(m.poisson > -1.0 && m.poisson < 0.5)) throw InputError(file, "poisson", std::to_string(m.poisson), "more than -1 and less than 0.5");
  if (!(std::isfinite(m.density) && m.density > 0.0)) throw InputError(file, "density", std::to_string(m.density), "a density above 0 kg/m3");
}

/// The systems of a step, in the precision asked for, and of rest.
struct LinearFem::Solvers {
  FemSystem<float> narrow, response;
  FemSystem<double> step, rest;
  bool rest_is_set = false;
  explicit Solvers(const BlockMatrix& K) : narrow(K), response(K), step(K), rest(K) {}
};

LinearFem::LinearFem(TetMesh mesh, std::vector<FemMaterial> regions, const FemOptions& options, const std::string& file)
    : mesh_(std::move(mesh)), regions_(std::move(regions)), options_(options) {
  check_mesh(mesh_, file);
  for (const FemMaterial& m : regions_) check_material(m, file);
  for (int e = 0; e < mesh_.n_tets(); ++e)
    if (mesh_.region_of(e) >= static_cast<int>(regions_.size()))
      throw InputError(file, "element " + std::to_string(e), "region " + std::to_string(mesh_.region_of(e)), "a region with a material");
  check_relaxation(options.relaxation, file);
  if (!(options.dt > 0.0)) throw InputError(file, "dt", std::to_string(options.dt), "a time step above 0 s");
  K_ = BlockMatrix(neighbours(mesh_, options.averaged_pressure));
  held_.assign(static_cast<std::size_t>(mesh_.n_nodes()), 0);
  mass_ = Eigen::VectorXd::Zero(mesh_.n_nodes());
  for (int e = 0; e < mesh_.n_tets(); ++e)
    for (const int i : mesh_.tets[static_cast<std::size_t>(e)])
      mass_[i] += 0.25 * regions_[static_cast<std::size_t>(mesh_.region_of(e))].density * tet_volume(mesh_, e);
  for (Columns4* c : {&right_, &change_, &work_}) *c = Columns4::Zero(4, mesh_.n_nodes());
  assemble(std::vector<char>(static_cast<std::size_t>(mesh_.n_tets()), 0));
}

LinearFem::~LinearFem() = default;

LinearFem::Gradients LinearFem::gradients(int e) const {
  const Tetrahedron& t = mesh_.tets[static_cast<std::size_t>(e)];
  Mat3 edges;
  for (int c = 0; c < 3; ++c) edges.col(c) = mesh_.nodes.col(t[static_cast<std::size_t>(c + 1)]) - mesh_.nodes.col(t[0]);
  Gradients g;
  g.volume = edges.determinant() / 6.0;
  g.b.rightCols<3>() = edges.inverse().transpose();
  g.b.col(0) = -g.b.rightCols<3>().rowwise().sum();
  return g;
}

void LinearFem::add_element(int e, double sign) {
  const Gradients g = gradients(e);
  const Tetrahedron& t = mesh_.tets[static_cast<std::size_t>(e)];
  auto [lambda, mu] = lame(regions_[static_cast<std::size_t>(mesh_.region_of(e))]);
  if (options_.averaged_pressure) lambda = -2.0 / 3.0 * mu;  // the change of volume is added by add_averaged_pressure
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) {
      const Vec3 bi = g.b.col(i), bj = g.b.col(j);
      const Mat3 block = lambda * bi * bj.transpose() + mu * bj * bi.transpose() + mu * bi.dot(bj) * Mat3::Identity();
      K_.add(t[static_cast<std::size_t>(i)], t[static_cast<std::size_t>(j)], sign * g.volume * block);
    }
}

/// Energy 1/2 sum_a kappa V_a theta_a^2 with theta_a = sum_e V_e/4 tr(eps_e) / V_a over the elements about node a.
void LinearFem::add_averaged_pressure(const std::vector<char>& removed) {
  const auto n = static_cast<std::size_t>(mesh_.n_nodes());
  std::vector<std::vector<int>> elements(n);
  for (int e = 0; e < mesh_.n_tets(); ++e)
    if (!removed[static_cast<std::size_t>(e)])
      for (const int i : mesh_.tets[static_cast<std::size_t>(e)]) elements[static_cast<std::size_t>(i)].push_back(e);
  for (const std::vector<int>& about : elements) {
    double volume = 0.0, bulk = 0.0;
    std::vector<std::pair<int, Vec3>> rows;  // V_a d theta_a / d u_i
    for (const int e : about) {
      const Gradients g = gradients(e);
      const auto [lambda, mu] = lame(regions_[static_cast<std::size_t>(mesh_.region_of(e))]);
      volume += 0.25 * g.volume;
      bulk += 0.25 * g.volume * (lambda + 2.0 / 3.0 * mu);
      for (int c = 0; c < 4; ++c) rows.emplace_back(mesh_.tets[static_cast<std::size_t>(e)][static_cast<std::size_t>(c)], 0.25 * g.volume * g.b.col(c));
    }
    if (volume <= 0.0) continue;
    std::sort(rows.begin(), rows.end(), [](const auto& x, const auto& y) { return x.first < y.first; });
    std::size_t last = 0;
    for (std::size_t k = 1; k < rows.size(); ++k) {
      if (rows[k].first == rows[last].first) rows[last].second += rows[k].second;
      else rows[++last] = rows[k];
    }
    rows.resize(last + 1);
    const double factor = bulk / (volume * volume);
    for (const auto& [i, gi] : rows)
      for (const auto& [j, gj] : rows) K_.add(i, j, factor * gi * gj.transpose());
  }
}

void LinearFem::assemble(const std::vector<char>& removed) {
  K_ = BlockMatrix(neighbours(mesh_, options_.averaged_pressure));
  for (int e = 0; e < mesh_.n_tets(); ++e)
    if (!removed[static_cast<std::size_t>(e)]) add_element(e, 1.0);
  if (options_.averaged_pressure) add_averaged_pressure(removed);
  removed_ = removed;
  solvers_ = std::make_unique<Solvers>(K_);
  set_systems();
}

void LinearFem::set_systems() {
  const double dt = options_.dt;
  const double scale = 1.0 + 2.0 / dt * options_.stiffness_damping;
  const Eigen::VectorXd inertia = (4.0 / (dt * dt) + 2.0 / dt * options_.mass_damping) * mass_;
  if (options_.single_precision) solvers_->narrow.set(scale, inertia, held_);
  else solvers_->step.set(scale, inertia, held_);
  solvers_->rest_is_set = false;
  if (responds_) prepare_response();
}

void LinearFem::hold(std::span<const int> nodes) {
  for (const int i : nodes) held_.at(static_cast<std::size_t>(i)) = 1;
  set_systems();
}

FemState LinearFem::rest() const {
  FemState s;
  s.u = s.v = s.a = s.du = Points::Zero(3, mesh_.n_nodes());
  s.w = Points::Zero(3, static_cast<Eigen::Index>(options_.relaxation.size()) * mesh_.n_nodes());
  s.removed.assign(static_cast<std::size_t>(mesh_.n_tets()), 0);
  return s;
}

FemSummary LinearFem::solve(FemState& s, std::span<MovedNode> moved, bool dynamic) noexcept {
  for (MovedNode& m : moved) m.target -= s.u.col(m.node);  // targets of the change
  const FemSummary summary = !dynamic                    ? solvers_->rest.solve(right_, change_, moved, options_.solver)
                             : options_.single_precision ? solvers_->narrow.solve(right_, &work_, change_, moved, options_.solver)
                                                         : solvers_->step.solve(right_, &work_, change_, moved, options_.solver);
  for (MovedNode& m : moved) m.target += s.u.col(m.node);
  return summary;
}

FemSummary LinearFem::step(FemState& s, std::span<MovedNode> moved, const Points* loads) noexcept {
  const double dt = options_.dt, alpha = options_.mass_damping, beta = options_.stiffness_damping;
  work_.topRows<3>() = beta * s.v - s.u;
  for (std::size_t k = 0; k < options_.relaxation.size(); ++k) {
    auto w = s.w.middleCols(static_cast<Eigen::Index>(k) * s.u.cols(), s.u.cols());
    w += (1.0 - std::exp(-dt / options_.relaxation[k].time)) * (s.u - w);
    work_.topRows<3>() += options_.relaxation[k].share * w;
  }
  for (int i = 0; i < mesh_.n_nodes(); ++i) {
    right_.col(i).head<3>() = mass_[i] * ((4.0 / dt + alpha) * s.v.col(i) + s.a.col(i));
    if (loads != nullptr) right_.col(i).head<3>() += loads->col(i);
    change_.col(i).head<3>() = s.du.col(i);  // warm start: as it went in the step before; v would bring the rule's own ringing along
  }
  const FemSummary summary = solve(s, moved, true);
  if (!summary.sound) {
    s.du.setZero();
    s.v.setZero();
    s.a.setZero();
    for (MovedNode& m : moved) m.force.setZero();
    return summary;
  }
  for (int i = 0; i < mesh_.n_nodes(); ++i) {
    const Vec3 du = change_.col(i).head<3>(), v = s.v.col(i);
    s.u.col(i) += du;
    s.du.col(i) = du;
    s.v.col(i) = 2.0 / dt * du - v;
    s.a.col(i) = 4.0 / (dt * dt) * du - 4.0 / dt * v - s.a.col(i);
  }
  for (const MovedNode& m : moved) {
    const double own = nodal_stiffness(m.node) + 4.0 / (dt * dt) * mass_[m.node], hold = m.stiffness.trace() / 3.0;
    const double share = m.prescribed ? 1.0 : hold / (hold + own);
    s.v.col(m.node) += share * (change_.col(m.node).head<3>() / dt - s.v.col(m.node));
    s.a.col(m.node) *= 1.0 - share;
    const double excess = s.v.col(m.node).dot(m.outward) - m.speed;
    if (excess > 0.0) s.v.col(m.node) -= share * excess * m.outward;
  }
  return summary;
}

FemSummary LinearFem::equilibrium(FemState& s, std::span<MovedNode> moved, const Points* loads) noexcept {
  if (!solvers_->rest_is_set) solvers_->rest.set(1.0, Eigen::VectorXd::Zero(mesh_.n_nodes()), held_);
  solvers_->rest_is_set = true;
  work_.topRows<3>() = -s.u;
  K_.times(work_, right_);
  if (loads != nullptr) right_.topRows<3>() += *loads;
  change_.setZero();
  const FemSummary summary = solve(s, moved, false);
  if (summary.sound) s.u += change_.topRows<3>();
  s.du.setZero();
  s.v.setZero();
  s.a.setZero();
  return summary;
}

void LinearFem::prepare_response() {
  solvers_->response.set(1.0, Eigen::VectorXd::Zero(mesh_.n_nodes()), held_);
  responds_ = true;
}

FemSummary LinearFem::respond(std::span<MovedNode> moved, Columns4& x) noexcept {
  FemSolverOptions few;
  few.relative = 1e-2;
  few.max_iterations = 8;
  work_.setZero();
  return solvers_->response.solve(work_, x, moved, few);
}

bool LinearFem::remove_element(FemState& s, int e) {
  auto& out = s.removed.at(static_cast<std::size_t>(e));
  if (out) return false;
  out = 1;
  if (options_.averaged_pressure || options_.single_precision) {
    assemble(s.removed);
    return true;
  }
  add_element(e, -1.0);
  removed_ = s.removed;
  set_systems();
  return true;
}

void LinearFem::match(const FemState& s) {
  if (s.removed != removed_) assemble(s.removed);
}

double LinearFem::energy(const FemState& s) const {
  const Points force = elastic_force(s.u);
  double sum = 0.5 * s.u.cwiseProduct(force).sum();
  for (int i = 0; i < mesh_.n_nodes(); ++i) sum += 0.5 * mass_[i] * s.v.col(i).squaredNorm();
  return sum;
}

Points LinearFem::elastic_force(const Points& u) const {
  Columns4 x = Columns4::Zero(4, u.cols()), y = x;
  x.topRows<3>() = u;
  K_.times(x, y);
  return y.topRows<3>();
}

Mat3 LinearFem::stress(const Eigen::Ref<const Points>& u, int e) const {
  Corners d;
  for (int c = 0; c < 4; ++c) d.col(c) = u.col(mesh_.tets[static_cast<std::size_t>(e)][static_cast<std::size_t>(c)]);
  return stress_of(gradients(e).b, d, lame(regions_[static_cast<std::size_t>(mesh_.region_of(e))]));
}

Mat3 LinearFem::relaxed_stress(const FemState& s, int e) const {
  Corners d;
  for (int c = 0; c < 4; ++c) {
    const int i = mesh_.tets[static_cast<std::size_t>(e)][static_cast<std::size_t>(c)];
    d.col(c) = s.u.col(i);
    for (std::size_t k = 0; k < options_.relaxation.size(); ++k) d.col(c) -= options_.relaxation[k].share * s.w.col(static_cast<Eigen::Index>(k) * s.u.cols() + i);
  }
  return stress_of(gradients(e).b, d, lame(regions_[static_cast<std::size_t>(mesh_.region_of(e))]));
}

double LinearFem::nodal_stiffness(int node) const noexcept { return K_.diagonal(node).trace() / 3.0; }

}  // namespace filum
