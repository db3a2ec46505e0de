// needle-insertion by the trainer's needle and track (physics/track_rig): a needle in a vice is driven into a block with the tissue's stiffness under its
// point, layer boundaries where the further ruptures are, and dry friction for each length inside, along each record's own path. Lengths and forces are
// scaled to the block (depth 0.6 mm, puncture 5 mN), which a quasi-static law does not see. What the track adds to the reduced model is the compliance of
// vice and block, the stick range of its friction at reversals, and the way from one layer to the next. Where a layer lies in a specimen is taken from its
// record (it gave way there under its force); when it gives way is for the simulation to find. Drag proportional to the speed alone is the reduced model's.

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "physics/track_rig.h"
#include "reconcile/full_solver.h"

namespace filum::reconcile {
namespace {

constexpr double kDepth = 0.6e-3, kBlock = 1.0e-3, kForce = 5e-3, kTouch = 20e-6;  // [m], [m], [N], [m] above the block at the start
constexpr double kMove = 4e-6;      // [m] a step
constexpr double kBeside = 0.02;    // of the depth, on either side of a rupture
constexpr int kSamples = 80;        // of a record that are run

/// Drives to `travel` [m] in steps of at most `move`; the force [N] there. On the way back the track leaves the wire ahead of its last knot free, up to
/// the knots' spacing (a twelfth of the way): its friction is added.
void drive(TrackRig& rig, double& at, double travel, double move, double friction, double& force) {
  const int n = static_cast<int>(std::ceil(std::abs(travel - at) / move - 1e-9));
  const double each = n > 0 ? (travel - at) / n : 0.0;
  for (int k = 0; k < n; ++k) force = rig.step(each).force;
  if (n > 0 && each < 0.0) force -= friction * rig.ahead();
  at = travel;
}

}  // namespace

std::vector<double> needle_forces(const NeedlePath& p, double move) {
  const double length = p.deepest / kDepth, force = p.puncture / kForce;
  RigOptions o;
  o.thickness = kBlock;
  const double rub = p.friction * length / force;
  TrackMaterial m = plain_track(kForce, 0.0, p.friction_from > 0.0 ? 0.0 : rub);
  m.point_stiffness = p.stiffness * length / force;
  m.layers.front().stiffness = p.touch * length / force;
  std::vector<NeedlePath::Rupture> faces = p.ruptures;  // from the surface down; the block counts from its inner face
  if (p.friction_from > 0.0) faces.push_back({p.friction_from + 1.5 * move * length, 0.0, 0.0});  // gives way at once; below where the point comes to when it pierces
  std::sort(faces.begin(), faces.end(), [](const auto& a, const auto& b) { return a.depth < b.depth; });
  std::vector<WallLayer> layers;
  double top = kBlock;
  for (const NeedlePath::Rupture& r : faces) {
    const double here = kBlock - r.depth / length;
    layers.insert(layers.begin(), {"layer", std::max(top - here, 1e-6), WallLaw::hooke(o.young, 0.3)});
    top = here;
    m.layers.insert(m.layers.begin(), {r.force / force, 0.0, r.depth < p.friction_from ? 0.0 : rub, 0.0, r.stiffness * length / force});
  }
  layers.insert(layers.begin(), {"deepest", top, WallLaw::hooke(o.young, 0.3)});
  o.layers = layers;
  o.track = m;
  TrackRig rig(o);
  std::vector<double> out;
  double at = -kTouch, now = 0.0;
  for (const double x : p.depth) {
    drive(rig, at, std::max(x / length, -kTouch), move, x > p.friction_from ? rub : 0.0, now);
    out.push_back(now * force);
  }
  return out;
}

namespace {

class NeedleSolver final : public FullSolver {
 public:
  explicit NeedleSolver(const RigModel& model) : model_(model) {}
  std::string name() const override { return "the trainer's needle in a track (physics/needle_track)"; }

  bool run(const Trial& t, const Setting& s, bool fine, Eigen::MatrixXd& out) const override {
    model_.rig(t, s, out);
    const auto drops = model_.drops(t);
    if (drops.empty() || t.at("depth")[drops[0]] <= 0.0) return true;  // never pierced: a spring, which the reduced model is
    Setting own;  // what the track knows of: stiffness, layers, friction of the length inside
    own.base = s.base, own.scale = s.scale;
    for (const Effect e : {Effect::rig_compliance, Effect::layer_rupture, Effect::shaft_friction}) {
      own.p[static_cast<std::size_t>(index_of(e))] = s.on(e);
      own.kind[static_cast<std::size_t>(index_of(e))] = s.form(e);
    }
    Eigen::MatrixXd reduced;
    model_.rig(t, own, reduced);
    const NeedlePath path = path_of(t, own, drops);
    const std::vector<double>& full = forces(path, fine);
    // between the samples that were run the difference is straight; about a rupture, whose instant is the record's and no model's, there is none
    const Eigen::VectorXd& x = t.at("depth");
    std::vector<double> more(full.size());
    for (std::size_t k = 0; k < full.size(); ++k) {
      if (!std::isfinite(full[k])) return false;
      const auto n = static_cast<Eigen::Index>(k) * stride(t);
      const bool event = std::any_of(drops.begin(), drops.end(), [&](int d) { return std::abs(x[n] - x[d]) < kBeside * path.deepest && std::abs(n - d) < t.samples() / 10; });
      more[k] = event ? 0.0 : path.puncture * full[k] - reduced(n, 0);
    }
    for (Eigen::Index n = 0; n < out.rows(); ++n) {
      const auto k = std::min(static_cast<std::size_t>(n / stride(t)), more.size() - 1), next = std::min(k + 1, more.size() - 1);
      const double w = static_cast<double>(n - static_cast<Eigen::Index>(k) * stride(t)) / static_cast<double>(stride(t));
      out(n, 0) += (1.0 - std::min(w, 1.0)) * more[k] + std::min(w, 1.0) * more[next];
    }
    return true;
  }

 private:
  static Eigen::Index stride(const Trial& t) { return std::max<Eigen::Index>(1, t.samples() / kSamples); }

  static NeedlePath path_of(const Trial& t, const Setting& s, const std::vector<int>& drops) {
    NeedlePath p;
    const Eigen::VectorXd& x = t.at("depth");
    for (Eigen::Index n = 0; n < x.size(); n += stride(t)) p.depth.push_back(x[n]);
    p.deepest = x.maxCoeff();
    p.stiffness = s.base[0] * s.scale;
    if (const double* c = s.on(Effect::rig_compliance)) p.stiffness /= 1.0 + p.stiffness * c[0];
    p.puncture = p.stiffness * x[drops[0]];
    if (const double* f = s.on(Effect::shaft_friction)) {
      const int form = s.form(Effect::shaft_friction);
      p.friction = f[0];
      if (form == 1) p.friction_from = x[drops[0]];
      if (form == 2) p.touch = p.stiffness + p.friction, p.puncture = p.touch * x[drops[0]];
    }
    const double* layer = s.on(Effect::layer_rupture);
    double before = x[drops[0]];
    for (std::size_t j = 1; layer != nullptr && j < drops.size(); ++j) {
      const double force = layer[j - 1] * s.scale, at = x[drops[j]];
      const bool own = s.form(Effect::layer_rupture) == 0 && force / p.stiffness < at - before;  // else it begins where the one before ended
      if (at > before) p.ruptures.push_back({own ? at - force / p.stiffness : before, force, own ? 0.0 : force / (at - before)});
      before = at;
    }
    return p;
  }

  /// Over the puncture's force.
  const std::vector<double>& forces(const NeedlePath& p, bool fine) const {
    // what counts are ratios: a record that is stiffer throughout runs the same way, and a thousandth is told apart from nothing
    const auto rounded = [](double v) { return std::round(1e3 * v) / 1e3; };
    std::vector<double> key = {fine ? 1.0 : 0.0, rounded(p.puncture / (p.stiffness * p.deepest)), rounded(p.friction / p.stiffness),
                               rounded(p.touch / p.stiffness), rounded(p.friction_from / p.deepest), static_cast<double>(p.depth.size()),
                               rounded(std::accumulate(p.depth.begin(), p.depth.end(), 0.0) / p.deepest), p.depth[p.depth.size() / 3] / p.deepest};
    for (const auto& r : p.ruptures) key.insert(key.end(), {rounded(r.depth / p.deepest), rounded(r.force / p.puncture), rounded(r.stiffness / p.stiffness)});
    const auto found = known_.find(key);
    if (found != known_.end()) return found->second;
    std::vector<double> f = needle_forces(p, fine ? 0.5 * kMove : kMove);
    for (double& v : f) v /= p.puncture;
    return known_.emplace(std::move(key), std::move(f)).first->second;
  }

  const RigModel& model_;
  mutable std::map<std::vector<double>, std::vector<double>> known_;
};

}  // namespace

std::unique_ptr<FullSolver> make_needle_solver(const RigModel& model) { return std::make_unique<NeedleSolver>(model); }

}  // namespace filum::reconcile
