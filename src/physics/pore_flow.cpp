#include "physics/pore_flow.h"

#include <Eigen/Eigenvalues>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.h"

namespace filum {

PoreLaw pore_law(const FemMaterial& sudden, const Drainage& d, const std::string& file) {
  check_material(sudden, file);
  const double nu = d.poisson_drained;
  if (!(d.diffusivity > 0.0 && std::isfinite(d.diffusivity))) throw InputError(file, "diffusivity", std::to_string(d.diffusivity), "a diffusivity above 0 m2/s");
  if (!(nu > -1.0 && nu < sudden.poisson)) throw InputError(file, "drained Poisson's ratio", std::to_string(nu), "more than -1 and less than that of a sudden load");
  const double G = sudden.young / (2.0 * (1.0 + sudden.poisson));
  const auto bulk = [&](double poisson) { return 2.0 * G * (1.0 + poisson) / (3.0 * (1.0 - 2.0 * poisson)); };
  PoreLaw law;
  law.Q = bulk(sudden.poisson) - bulk(nu);
  const double M = bulk(nu) + 4.0 / 3.0 * G;
  law.k = d.diffusivity * (1.0 / M + 1.0 / law.Q);
  law.drained = {2.0 * G * (1.0 + nu), nu, sudden.density};
  return law;
}

PoreMesh::PoreMesh(const TetMesh& mesh, const std::vector<double>& k) {
  const auto n = static_cast<std::size_t>(mesh.n_nodes());
  struct Link {
    Vec3 gradient = Vec3::Zero();
    double flow = 0.0;
  };
  std::vector<std::map<int, Link>> links(n);
  volume_ = Eigen::VectorXd::Zero(mesh.n_nodes());
  for (int e = 0; e < mesh.n_tets(); ++e) {
    const Tetrahedron& t = mesh.tets[static_cast<std::size_t>(e)];
    Mat3 edges;
    for (int c = 0; c < 3; ++c) edges.col(c) = mesh.nodes.col(t[static_cast<std::size_t>(c + 1)]) - mesh.nodes.col(t[0]);
    const double volume = edges.determinant() / 6.0;
    Eigen::Matrix<double, 3, 4> b;
    b.rightCols<3>() = edges.inverse().transpose();
    b.col(0) = -b.rightCols<3>().rowwise().sum();
    for (int i = 0; i < 4; ++i) {
      const int a = t[static_cast<std::size_t>(i)];
      volume_[a] += 0.25 * volume;
      for (int j = 0; j < 4; ++j) {
        Link& link = links[static_cast<std::size_t>(a)][t[static_cast<std::size_t>(j)]];
        link.gradient += 0.25 * volume * b.col(j);
        link.flow += k[static_cast<std::size_t>(e)] * volume * b.col(i).dot(b.col(j));
      }
    }
  }
  begin_.push_back(0);
  for (const auto& row : links) {
    for (const auto& [j, link] : row) {
      node_.push_back(j);
      gradient_.push_back(link.gradient);
      flow_.push_back(link.flow);
    }
    begin_.push_back(static_cast<int>(node_.size()));
  }
}

std::span<const int> PoreMesh::near(int a) const noexcept {
  const int from = begin_[static_cast<std::size_t>(a)], to = begin_[static_cast<std::size_t>(a) + 1];
  return {node_.data() + from, static_cast<std::size_t>(to - from)};
}

double PoreMesh::growth(int a, const Eigen::Ref<const Points>& u) const noexcept {
  double sum = 0.0;
  for (int k = begin_[static_cast<std::size_t>(a)]; k < begin_[static_cast<std::size_t>(a) + 1]; ++k) sum += gradient_[static_cast<std::size_t>(k)].dot(u.col(node_[static_cast<std::size_t>(k)]));
  return sum;
}

void PoreMesh::push(const Eigen::VectorXd& p, Points& loads) const noexcept {
  for (int a = 0; a < n(); ++a)
    for (int k = begin_[static_cast<std::size_t>(a)]; k < begin_[static_cast<std::size_t>(a) + 1]; ++k) loads.col(node_[static_cast<std::size_t>(k)]) += p[a] * gradient_[static_cast<std::size_t>(k)];
}

double PoreMesh::outflow(int a, const Eigen::VectorXd& p) const noexcept {
  double sum = 0.0;
  for (int k = begin_[static_cast<std::size_t>(a)]; k < begin_[static_cast<std::size_t>(a) + 1]; ++k) sum += flow_[static_cast<std::size_t>(k)] * p[node_[static_cast<std::size_t>(k)]];
  return sum;
}

double PoreMesh::own_conductance(int a) const noexcept {
  const auto list = near(a);
  return conductance(a, static_cast<std::size_t>(std::lower_bound(list.begin(), list.end(), a) - list.begin()));
}

// ---- in a scene

namespace {

std::vector<PoreLaw> laws_of(const std::vector<FemMaterial>& regions, const Drainage& d, const std::string& file) {
  std::vector<PoreLaw> laws;
  for (const FemMaterial& m : regions) laws.push_back(pore_law(m, d, file));
  return laws;
}

std::vector<double> conductivity(const TetMesh& mesh, const std::vector<PoreLaw>& laws) {
  std::vector<double> k;
  for (int e = 0; e < mesh.n_tets(); ++e) k.push_back(laws[static_cast<std::size_t>(mesh.region_of(e))].k);
  return k;
}

}  // namespace

PoreFlow::PoreFlow(const TetMesh& mesh, const std::vector<FemMaterial>& regions, const Drainage& d, const std::string& file)
    : mesh_(mesh, conductivity(mesh, laws_of(regions, d, file))), Q_(Eigen::VectorXd::Zero(mesh.n_nodes())), theta_(Q_), p_(Q_) {
  const std::vector<PoreLaw> laws = laws_of(regions, d, file);
  for (int e = 0; e < mesh.n_tets(); ++e)
    for (const int a : mesh.tets[static_cast<std::size_t>(e)]) Q_[a] += 0.25 * tet_volume(mesh, e) / mesh_.volume(a) * laws[static_cast<std::size_t>(mesh.region_of(e))].Q;
  longest_ = INFINITY;  // forward Euler: rows of Q H/V sum to 2 of its diagonal at most
  for (int a = 0; a < n(); ++a) longest_ = std::min(longest_, 0.5 * mesh_.volume(a) / (Q_[a] * mesh_.own_conductance(a)));
}

void PoreFlow::step(const Eigen::Ref<const Points>& u, const std::vector<char>& open, double dt, Eigen::VectorXd& content, Points& loads) noexcept {
  const int parts = std::clamp(static_cast<int>(std::ceil(dt / longest_)), 1, 64);
  const double h = std::min(dt / parts, longest_);
  for (int a = 0; a < n(); ++a) theta_[a] = mesh_.growth(a, u) / mesh_.volume(a);
  for (int part = 0; part < parts; ++part) {
    for (int a = 0; a < n(); ++a) {
      if (open[static_cast<std::size_t>(a)]) content[a] = theta_[a];
      p_[a] = Q_[a] * (content[a] - theta_[a]);
    }
    for (int a = 0; a < n(); ++a)
      if (!open[static_cast<std::size_t>(a)]) content[a] -= h * mesh_.outflow(a, p_) / mesh_.volume(a);
  }
  p_ = Q_.cwiseProduct(content);
  mesh_.push(p_, loads);
}

double PoreFlow::pressure(int a, const Eigen::Ref<const Points>& u, const Eigen::VectorXd& content) const noexcept { return Q_[a] * (content[a] - mesh_.growth(a, u) / mesh_.volume(a)); }

// ---- modes of a body

double DrainingForce::sudden() const {
  double sum = rest;
  for (const double w : weight) sum += w;
  return sum;
}

namespace {

using Sparse = Eigen::SparseMatrix<double>;
using Vector = Eigen::VectorXd;

/// A p' + H p = -b e', F = rest e - b.p on the pressures that are not open: Biot's equations with the displacement eliminated.
class Storage {
 public:
  Storage(const DrainingBody& body, const PoreLaw& law) : mesh_(body.mesh, std::vector<double>(body.mesh.tets.size(), law.k)), motion_(body.motion) {
    FemOptions o;
    o.averaged_pressure = true;
    const LinearFem fem(body.mesh, {law.drained}, o, "draining body");
    number_.assign(body.held.size(), -1);
    for (std::size_t i = 0; i < body.held.size(); ++i)
      if (!body.held[i]) number_[i] = size_++;
    factor(fem);
    for (int a = 0; a < mesh_.n(); ++a)
      if (!body.open[static_cast<std::size_t>(a)]) pressures_.push_back(a);
    storage_.resize(pressures());
    for (int i = 0; i < pressures(); ++i) storage_[i] = mesh_.volume(node(i)) / law.Q;
    drain(fem);
    flow_factor();
  }
  int pressures() const { return static_cast<int>(pressures_.size()); }
  const Vector& b() const { return b_; }
  double rest() const { return rest_; }
  Vector times(const Vector& x) const {  // A x
    Vector all = Vector::Zero(mesh_.n());
    for (int i = 0; i < pressures(); ++i) all[node(i)] = x[i];
    Points push = Points::Zero(3, mesh_.n());
    mesh_.push(all, push);
    const Points u = bend(push);
    Vector out(pressures());
    for (int i = 0; i < pressures(); ++i) out[i] = storage_[i] * x[i] + mesh_.growth(node(i), u);
    return out;
  }
  Vector settle(const Vector& x) const { return flow_.solve(x); }  // H^-1 x
  /// A^-1 x by conjugate gradients, preconditioned by the storage of a laterally held column, which is near.
  Vector sudden(const Vector& x) const {
    Vector y = Vector::Zero(x.size()), r = x, z = r.cwiseQuotient(storage_), p = z;
    double rz = r.dot(z);
    const double enough = 1e-20 * rz;
    for (int k = 0; k < 400 && rz > enough; ++k) {
      const Vector Ap = times(p);
      const double alpha = rz / p.dot(Ap);
      y += alpha * p;
      r -= alpha * Ap;
      z = r.cwiseQuotient(storage_);
      const double next = r.dot(z);
      p = z + next / rz * p;
      rz = next;
    }
    return y;
  }

 private:
  int node(int i) const { return pressures_[static_cast<std::size_t>(i)]; }
  int number(int i, int c) const { return number_[3 * static_cast<std::size_t>(i) + static_cast<std::size_t>(c)]; }
  void factor(const LinearFem& fem) {
    const BlockMatrix& K = fem.stiffness();
    std::vector<Eigen::Triplet<double>> entries;
    for (int i = 0; i < K.n(); ++i)
      for (int k = K.begins()[static_cast<std::size_t>(i)]; k < K.begins()[static_cast<std::size_t>(i) + 1]; ++k) {
        const int j = K.columns()[static_cast<std::size_t>(k)];
        const Mat3 block = K.at(static_cast<std::size_t>(k));
        for (int c = 0; c < 3; ++c)
          for (int d = 0; d < 3; ++d)
            if (number(i, c) >= number(j, d) && number(j, d) >= 0) entries.emplace_back(number(i, c), number(j, d), block(c, d));
      }
    Sparse A(size_, size_);
    A.setFromTriplets(entries.begin(), entries.end());
    stiff_.compute(A);
    sound_ = stiff_.info() == Eigen::Success;
  }
  Points bend(const Points& push) const {
    Vector f(size_);
    for (int i = 0; i < mesh_.n(); ++i)
      for (int c = 0; c < 3; ++c)
        if (number(i, c) >= 0) f[number(i, c)] = push(c, i);
    const Vector x = sound_ ? Vector(stiff_.solve(f)) : Vector::Constant(size_, NAN);
    Points u = Points::Zero(3, mesh_.n());
    for (int i = 0; i < mesh_.n(); ++i)
      for (int c = 0; c < 3; ++c)
        if (number(i, c) >= 0) u(c, i) = x[number(i, c)];
    return u;
  }
  void drain(const LinearFem& fem) {
    Points u = motion_;
    for (int i = 0; i < mesh_.n(); ++i)
      for (int c = 0; c < 3; ++c)
        if (number(i, c) >= 0) u(c, i) = 0.0;
    u += bend(-fem.elastic_force(u));
    rest_ = u.cwiseProduct(fem.elastic_force(u)).sum();
    b_.resize(pressures());
    for (int i = 0; i < pressures(); ++i) b_[i] = mesh_.growth(node(i), u);
  }
  void flow_factor() {
    std::vector<int> place(static_cast<std::size_t>(mesh_.n()), -1);
    for (int i = 0; i < pressures(); ++i) place[static_cast<std::size_t>(node(i))] = i;
    std::vector<Eigen::Triplet<double>> entries;
    for (int i = 0; i < pressures(); ++i) {
      const auto near = mesh_.near(node(i));
      for (std::size_t k = 0; k < near.size(); ++k)
        if (place[static_cast<std::size_t>(near[k])] >= 0) entries.emplace_back(i, place[static_cast<std::size_t>(near[k])], mesh_.conductance(node(i), k));
    }
    Sparse H(pressures(), pressures());
    H.setFromTriplets(entries.begin(), entries.end());
    flow_.compute(H);
  }

  PoreMesh mesh_;
  Points motion_;
  std::vector<int> number_, pressures_;
  int size_ = 0;
  bool sound_ = false;
  Eigen::SimplicialLDLT<Sparse> stiff_, flow_;
  Vector storage_, b_;
  double rest_ = 0.0;
};

}  // namespace

DrainingForce draining_force(const DrainingBody& body, int terms) {
  const PoreLaw law = pore_law(body.tissue, body.drainage, "draining body");
  const Storage A(body, law);
  DrainingForce out;
  out.rest = A.rest();
  Vector v = A.sudden(A.b());
  const double total = A.b().dot(v);  // [N/m]: what drains away
  if (!(total > 0.0)) return out;
  const int m = std::min(terms, A.pressures());
  Eigen::MatrixXd basis(A.pressures(), m), stored(A.pressures(), m), T = Eigen::MatrixXd::Zero(m, m);
  int k = 0;
  for (; k < m; ++k) {
    Vector Av = A.times(v);
    const double size = std::sqrt(v.dot(Av));
    if (!(size > 1e-10 * (k == 0 ? 0.0 : T(k - 1, k - 1)))) break;
    if (k > 0) T(k, k - 1) = T(k - 1, k) = size;
    basis.col(k) = v / size;
    stored.col(k) = Av / size;
    v = A.settle(stored.col(k));
    T(k, k) = v.dot(stored.col(k));
    for (int again = 0; again < 2; ++again)  // orthogonal in the inner product of storage, to the last digit
      v -= basis.leftCols(k + 1) * (stored.leftCols(k + 1).transpose() * v);
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(T.topLeftCorner(k, k));
  for (int i = k; i-- > 0;) {
    const double w = total * eigen.eigenvectors()(0, i) * eigen.eigenvectors()(0, i);
    if (eigen.eigenvalues()[i] <= 0.0) {
      out.weight.back() += w;
      continue;
    }
    out.weight.push_back(w);
    out.time.push_back(eigen.eigenvalues()[i]);
  }
  return out;
}

}  // namespace filum
