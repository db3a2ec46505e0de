#include "physics/tissue_law.h"

#include <algorithm>

namespace filum {
namespace {

Mat3 full(const Eigen::Matrix<double, 6, 1>& v) noexcept {
  Mat3 m;
  m << v[0], v[3], v[5], v[3], v[1], v[4], v[5], v[4], v[2];
  return m;
}

Eigen::Matrix<double, 6, 1> packed(const Mat3& m) noexcept {
  Eigen::Matrix<double, 6, 1> v;
  v << m(0, 0), m(1, 1), m(2, 2), m(0, 1), m(1, 2), m(2, 0);
  return v;
}

}  // namespace

ElementLaw::ElementLaw(const TetMesh& mesh, const std::vector<FemMaterial>& regions, const TissueLaw& law) : law_(law) {
  for (int e = 0; e < mesh.n_tets(); ++e) {
    Element out{};
    out.nodes = mesh.tets[static_cast<std::size_t>(e)];
    Mat3 edges;
    for (int c = 0; c < 3; ++c) edges.col(c) = mesh.nodes.col(out.nodes[static_cast<std::size_t>(c + 1)]) - mesh.nodes.col(out.nodes[0]);
    out.volume = edges.determinant() / 6.0;
    out.b.rightCols<3>() = edges.inverse().transpose();
    out.b.col(0) = -out.b.rightCols<3>().rowwise().sum();
    const FemMaterial& m = regions.at(static_cast<std::size_t>(mesh.region_of(e)));
    out.ratio = 2.0 * (1.0 + m.poisson);
    out.G = m.young / out.ratio;
    elements_.push_back(out);
  }
}

TissueMemory ElementLaw::start() const {
  const auto n = static_cast<Eigen::Index>(elements_.size());
  return {Eigen::Matrix<double, 6, Eigen::Dynamic>::Zero(6, n), Eigen::VectorXd::Zero(n)};
}

Mat3 ElementLaw::deviator(const Element& e, const Eigen::Ref<const Points>& u) noexcept {
  Mat3 gradient = Mat3::Zero();
  for (int c = 0; c < 4; ++c) gradient += u.col(e.nodes[static_cast<std::size_t>(c)]) * e.b.col(c).transpose();
  Mat3 strain = 0.5 * (gradient + gradient.transpose());
  strain.diagonal().array() -= strain.trace() / 3.0;
  return strain;
}

Mat3 ElementLaw::shifted(const Mat3& strain, const Eigen::Matrix<double, 6, 1>& peak) const noexcept {
  if (law_.set == 0.0) return strain;
  const Mat3 most = full(peak);
  const double grown = law_.set_strain > 0.0 ? std::sqrt(most.squaredNorm() / 1.5) / law_.set_strain : 1.0;
  return strain - std::min(law_.set * grown, 1.0) * most;
}

double ElementLaw::secant(double square, double top, double young_over_G) const noexcept {
  const double x = 4.0 * law_.stiffening * square;  // 2 r J
  double s = std::min(law_.exponential ? std::exp(std::min(x, 50.0)) : 1.0 + x, law_.limit);
  if (law_.softening > 0.0) s *= 1.0 - law_.softening * softening_share(std::max(top - square, 0.0) / (law_.softening_energy * young_over_G), law_.softening_form);
  return s;
}

void ElementLaw::push(const Eigen::Ref<const Points>& u, const TissueMemory& m, const std::vector<char>& removed, Points& loads) const noexcept {
  for (std::size_t i = 0; i < elements_.size(); ++i) {
    if (removed[i]) continue;
    const Element& e = elements_[i];
    const auto k = static_cast<Eigen::Index>(i);
    const Mat3 strain = deviator(e, u), shift = shifted(strain, m.peak.col(k));
    const Mat3 missing = 2.0 * e.G * e.volume * (strain - secant(shift.squaredNorm(), m.top[k], e.ratio) * shift);
    for (int c = 0; c < 4; ++c) loads.col(e.nodes[static_cast<std::size_t>(c)]) += missing * e.b.col(c);
  }
}

void ElementLaw::remember(const Eigen::Ref<const Points>& u, TissueMemory& m) const noexcept {
  for (std::size_t i = 0; i < elements_.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const Mat3 strain = deviator(elements_[i], u);
    if (strain.squaredNorm() > full(m.peak.col(k)).squaredNorm()) m.peak.col(k) = packed(strain);
    m.top[k] = std::max(m.top[k], shifted(strain, m.peak.col(k)).squaredNorm());
  }
}

double ElementLaw::mean_square(const Eigen::Ref<const Points>& u) const noexcept {
  double sum = 0.0, weight = 0.0;
  for (const Element& e : elements_) {
    const double square = deviator(e, u).squaredNorm();
    weight += e.G * e.volume * square;
    sum += e.G * e.volume * square * square;
  }
  return weight > 0.0 ? sum / weight : 0.0;
}

}  // namespace filum
