// A blade on tissue whose elements stiffen, soften and set (physics/tissue_law): equilibria along a loading to the record's peak and back, by fixed-point steps of
// the linear tissue with Anderson's acceleration (J. ACM 12:547, 1965; type II, five differences).
// The contract gives these laws by depth over height; within the tissue the same energy is spread unevenly. A material's own values follow from those by
// the mean of dev(eps):dev(eps) of the linear solution, weighted by its energy, over 3/2 (depth/height)^2: then the first order of every law is the contract's,
// and what the mesh adds is how the field gives way. Small strains; the blade sticks.

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "physics/linear_fem.h"
#include "reconcile/full_solver.h"

namespace filum::reconcile {
namespace {

constexpr int kDifferences = 5, kMostSteps = 60;

class PressedTissue {
 public:
  PressedTissue(const PressedBox& box, double poisson)
      : material_{1.0, poisson, 1000.0}, fem_(box.mesh, {material_}, options(), "box of tissue"), removed_(box.mesh.tets.size(), 0) {
    std::vector<int> held;
    for (int i = 0; i < box.mesh.n_nodes(); ++i) {
      const auto at = static_cast<std::size_t>(i);
      MovedNode m;
      m.node = i;
      if (box.bottom[at]) {
        held.push_back(i);
      } else if (box.blade[at]) {
        moved_.push_back(m);
      } else if (box.middle_x[at] || box.middle_y[at]) {
        m.prescribed = false;
        const double k = 1e4 * fem_.nodal_stiffness(i);
        m.stiffness = Vec3(box.middle_x[at] ? k : 0.0, box.middle_y[at] ? k : 0.0, 0.0).asDiagonal();
        moved_.push_back(m);
      }
    }
    fem_.hold(held);
    loads_ = Points::Zero(3, box.mesh.n_nodes());
  }
  const LinearFem& fem() const { return fem_; }
  const FemMaterial& material() const { return material_; }
  const std::vector<char>& removed() const { return removed_; }

  /// Equilibrium at this depth under loads, from u; the force on the blade in `force`.
  bool rest(double depth, const Points& loads, Points& u, double& force) {
    for (MovedNode& m : moved_)
      if (m.prescribed) m.target = Vec3(0, 0, -depth);
    FemState s = fem_.rest();
    s.u = u;
    const FemSummary summary = fem_.equilibrium(s, moved_, &loads);
    u = s.u;
    force = 0.0;
    for (const MovedNode& m : moved_)
      if (m.prescribed) force -= 4.0 * m.force.z();
    return summary.sound;
  }

  /// The same with the law's elements; `beta`: share of each step that is taken before acceleration.
  bool rest(double depth, const ElementLaw& law, const TissueMemory& memory, double beta, Points& u, double& force) {
    Eigen::MatrixXd dx(u.size(), 0), dr(u.size(), 0);
    Eigen::VectorXd last_x, last_r;
    for (int k = 0; k < kMostSteps; ++k) {
      loads_.setZero();
      law.push(u, memory, removed_, loads_);
      Points next = u;
      if (!rest(depth, loads_, next, force)) return false;
      const Eigen::VectorXd x = Eigen::Map<const Eigen::VectorXd>(u.data(), u.size()), r = Eigen::Map<const Eigen::VectorXd>(next.data(), next.size()) - x;
      if (r.cwiseAbs().maxCoeff() < 3e-4 * std::abs(depth) + 1e-12) return u = next, true;
      if (k > 0) {
        const Eigen::Index keep = std::min<Eigen::Index>(dx.cols(), kDifferences - 1);
        Eigen::MatrixXd a(x.size(), keep + 1), b(x.size(), keep + 1);
        a << dx.rightCols(keep), x - last_x;
        b << dr.rightCols(keep), r - last_r;
        dx = std::move(a), dr = std::move(b);
      }
      last_x = x, last_r = r;
      Eigen::VectorXd step = beta * r;
      if (dr.cols() > 0) {
        const Eigen::VectorXd weights = dr.colPivHouseholderQr().solve(r);
        step -= (dx + beta * dr) * weights;
      }
      Eigen::Map<Eigen::VectorXd>(u.data(), u.size()) += step;
    }
    return false;
  }

 private:
  static FemOptions options() {
    FemOptions o;
    o.averaged_pressure = true;
    o.solver.relative = 1e-5;
    o.solver.max_iterations = 2000;
    return o;
  }
  FemMaterial material_;
  LinearFem fem_;
  std::vector<char> removed_;
  std::vector<MovedNode> moved_;
  Points loads_;
};

}  // namespace

double local_strain_square(const PressedBox& box, double height, double poissons_ratio) {
  PressedTissue tissue(box, poissons_ratio);
  Points u = Points::Zero(3, box.mesh.n_nodes());
  double force = 0.0;
  if (!tissue.rest(height, Points::Zero(3, box.mesh.n_nodes()), u, force)) return NAN;  // a strain of one: the problem is linear
  return ElementLaw(box.mesh, {tissue.material()}, {}).mean_square(u) / 1.5;
}

PressTable press_table(const PressedBox& box, double height, double poissons_ratio, const TissueLaw& law, double local_square, double peak, const std::function<double(double, double)>& reduced) {
  PressedTissue tissue(box, poissons_ratio);
  TissueLaw local = law;
  local.stiffening /= local_square;
  local.softening_energy *= local_square;
  local.set_strain *= std::sqrt(local_square);
  const ElementLaw elements(box.mesh, {tissue.material()}, local);
  TissueMemory memory = elements.start();
  Points u = Points::Zero(3, box.mesh.n_nodes());
  double unit = 0.0, force = 0.0;
  PressTable out;
  out.peak = peak;
  if (!tissue.rest(height, Points::Zero(3, u.cols()), u, unit)) return out;
  const double beta = 1.0 / (1.0 + std::min(6.0 * law.stiffening * peak * peak, 3.0));
  const int n = PressTable::kPoints;
  u *= peak / n;
  out.load = out.unload = {0.0};
  for (int i = 1; i <= n; ++i) {  // the memory of the largest strain so far is that of this depth: found together
    const double e = peak * i / n;
    for (int pass = 0; pass < 3; ++pass) {
      elements.remember(u, memory);
      if (!tissue.rest(height * e, elements, memory, beta, u, force)) return out.load.clear(), out;
      if (law.set == 0.0 && law.softening == 0.0) break;
    }
    out.load.push_back(force / unit - reduced(e, e));
    if (i < n) u *= (i + 1.0) / i;
  }
  elements.remember(u, memory);
  out.unload.assign(static_cast<std::size_t>(n) + 1, out.load.back());
  const bool remembers = law.set > 0.0 || law.softening > 0.0;
  for (int i = n; i-- > 0;) {
    if (!remembers) {
      out.unload[static_cast<std::size_t>(i)] = out.load[static_cast<std::size_t>(i)];
      continue;
    }
    const double e = peak * i / n;
    if (!tissue.rest(height * std::max(e, 1e-6 * peak), elements, memory, beta, u, force)) return out.load.clear(), out;
    out.unload[static_cast<std::size_t>(i)] = force / unit - reduced(e, peak);
  }
  return out;
}

}  // namespace filum::reconcile
