#include "physics/tissue_law.h"

#include <Eigen/Eigenvalues>

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

constexpr double kWidest = 0.5, kStep = 1e-3;  // strains of the table

/// h(x) - x of the header's asymmetry at -kWidest, -kWidest + kStep ... kWidest. Where there is a limit the slope of h is held between -0.45 and the mean
/// of the limit and 1: it is 1 or more on the stiff side, so the block's own tangent, 2/3 (h'(e) + h'(-e/2)/2), stays positive.
std::vector<double> asymmetry_table(const TissueLaw& law) {
  const double most = 0.5 * (law.limit - 1.0), least = std::isfinite(law.limit) ? -1.45 : -INFINITY;
  const auto beyond = [&](double x) {
    double sum = 0.0;
    for (int k = 0; k < 24; ++k, x *= -0.5) sum += 1.5 * asymmetric_stress(x, law.asymmetry, law.asymmetry_form);
    return sum;
  };
  const int half = static_cast<int>(std::lround(kWidest / kStep));
  std::vector<double> out(2 * static_cast<std::size_t>(half) + 1, 0.0);
  for (const int way : {-1, 1})
    for (int i = 1; i <= half; ++i) {
      const double rise = way * (beyond(way * i * kStep) - beyond(way * (i - 1) * kStep)) / kStep;
      out[static_cast<std::size_t>(half + way * i)] = out[static_cast<std::size_t>(half + way * (i - 1))] + way * kStep * std::clamp(rise, least, most);
    }
  return out;
}

}  // namespace

double asymmetric_stress(double e, double alpha, int form) noexcept {
  if (form != 0) return (0.25 * alpha - 1.5) * (form == 1 ? e * e : 0.1 * std::abs(e));
  const double l = std::max(1.0 + e, 0.05);
  return 2.0 / (3.0 * alpha) * (std::pow(l, alpha - 1.0) - std::pow(l, -0.5 * alpha - 1.0)) - e;
}

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
  if (law.asymmetry != 0.0) table_ = asymmetry_table(law);
}

double ElementLaw::principal(double x) const noexcept {
  const double at = (std::clamp(x, -kWidest, kWidest) + kWidest) / kStep;
  const auto k = std::min(static_cast<std::size_t>(at), table_.size() - 2);
  return table_[k] + (at - static_cast<double>(k)) * (table_[k + 1] - table_[k]);
}

Mat3 ElementLaw::asymmetric(const Mat3& strain) const noexcept {
  Eigen::SelfAdjointEigenSolver<Mat3> axes;
  axes.computeDirect(strain);
  Vec3 more;
  for (int i = 0; i < 3; ++i) more[i] = principal(axes.eigenvalues()[i]);
  more.array() -= more.mean();
  return axes.eigenvectors() * more.asDiagonal() * axes.eigenvectors().transpose();
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
  if (law_.softening > 0.0) s *= softened(square, top, young_over_G);
  return s;
}

double ElementLaw::softened(double square, double top, double young_over_G) const noexcept {
  if (law_.softening == 0.0) return 1.0;
  return 1.0 - law_.softening * softening_share(std::max(top - square, 0.0) / (law_.softening_energy * young_over_G), law_.softening_form);
}

void ElementLaw::push(const Eigen::Ref<const Points>& u, const TissueMemory& m, const std::vector<char>& removed, Points& loads) const noexcept {
  for (std::size_t i = 0; i < elements_.size(); ++i) {
    if (removed[i]) continue;
    const Element& e = elements_[i];
    const auto k = static_cast<Eigen::Index>(i);
    const Mat3 strain = deviator(e, u), shift = shifted(strain, m.peak.col(k));
    const double square = shift.squaredNorm();
    Mat3 missing = 2.0 * e.G * e.volume * (strain - secant(square, m.top[k], e.ratio) * shift);
    if (!table_.empty() && square > 0.0) missing -= 2.0 * e.G * e.volume * softened(square, m.top[k], e.ratio) * asymmetric(shift);
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
