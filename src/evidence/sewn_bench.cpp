#include "evidence/sewn_bench.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "world/needle_model.h"
#include "world/vessel_model.h"
#include "world/world.h"

namespace filum {
namespace {

constexpr double kTail = 3e-3, kSewnEdge = 0.15e-3, kFreeEdge = 1e-3;  // [m]
constexpr double kDeep = 0.9;                                          // zeta of the outermost and innermost points of a track
constexpr int kSettle = 250;                                           // steps

struct Pass {
  int part;
  std::array<WallPoint, 3> at;
  std::array<double, 3> arc;  // [m], along the path
};

/// A path that is built up point by point; edges no longer than `longest`.
class Path {
 public:
  void start(const Vec3& p) { points_ = {p}; }
  void to(const Vec3& p, double longest) {
    const Vec3 from = points_.back();
    const int n = std::max(1, static_cast<int>(std::ceil((p - from).norm() / longest)));
    for (int k = 1; k <= n; ++k) points_.push_back(from + (p - from) * (static_cast<double>(k) / n));
    length_ += (p - from).norm();
  }
  double length() const { return length_; }
  Points points() const {
    Points x(3, static_cast<Eigen::Index>(points_.size()));
    for (std::size_t k = 0; k < points_.size(); ++k) x.col(static_cast<Eigen::Index>(k)) = points_[k];
    return x;
  }

 private:
  std::vector<Vec3> points_;
  double length_ = 0.0;
};

Vec3 place(const VesselMesh& mesh, const Points& x, const WallPoint& at) {
  const auto weight = corner_weights(at.local);
  Vec3 p = Vec3::Zero();
  for (std::size_t a = 0; a < 8; ++a) p += weight[static_cast<Eigen::Index>(a)] * x.col(mesh.elements[static_cast<std::size_t>(at.element)][a]);
  return p;
}

/// The element of a part in this row from the cut edge that lies in this direction from the axis.
int element_at(const VesselModel& v, const Points& x, int part, int row, const Vec3& direction) {
  const int half = v.mesh.n_elements() / 2, first = part * half + (v.shape.along - row) * v.shape.around;
  int best = first;
  double most = -2.0;
  for (int e = first; e < first + v.shape.around; ++e) {
    const Vec3 r = place(v.mesh, x, {e, Vec3::Zero()}) - v.clamp.X_WB.p;
    const Vec3 axis = v.clamp.X_WB.q * Vec3::UnitZ();
    if (const double like = (r - r.dot(axis) * axis).normalized().dot(direction); like > most) {
      most = like;
      best = e;
    }
  }
  return best;
}

/// Through one edge: from outside (part 0) or from the lumen (part 1).
void sew(const VesselModel& v, const Points& x, int part, int row, const Vec3& direction, Path& path, std::vector<Pass>& passes) {
  Pass pass{part, {}, {}};
  const int element = element_at(v, x, part, row, direction);
  for (std::size_t k = 0; k < 3; ++k) {
    const double zeta = kDeep * (part == 0 ? 1.0 - static_cast<double>(k) : static_cast<double>(k) - 1.0);
    pass.at[k] = {element, Vec3(0.0, 0.0, zeta)};
    path.to(place(v.mesh, x, pass.at[k]), kSewnEdge);
    pass.arc[k] = path.length();
  }
  passes.push_back(pass);
}

NeedleTrack track_of(const Pass& pass, double whole, double wire) {
  NeedleTrack t;
  t.n = 3;
  t.out = 1;
  t.part = pass.part;
  t.shallow = 0.05;
  t.deep = 0.95;
  t.hole = wire;
  t.entry = pass.at[0];
  t.exit = pass.at[2];
  for (std::size_t k = 0; k < 3; ++k) t.knots[k] = {pass.at[k], pass.arc[k] - whole, k == 0 ? 0.0 : pass.arc[k] - pass.arc[k - 1], 0.0};
  return t;
}

}  // namespace

std::pair<std::shared_ptr<const Model>, State> sewn_stumps(const std::shared_ptr<const Model>& of, int stitches, int row) {
  const VesselModel& v = *of->vessel;
  const Points rest = World(of).state().tissue.wall.x;
  const Vec3 axis = v.clamp.X_WB.q * Vec3::UnitZ(), middle = v.clamp.X_WB.p, up = v.cut_along;
  const auto direction = [&](double turns) { return Vec3(Eigen::AngleAxisd(2.0 * std::numbers::pi * turns, axis) * up); };
  Path path;
  std::vector<Pass> passes;
  for (int k = 0; k < stitches; ++k) {
    const double turn = static_cast<double>(k) / stitches;
    if (k == 0) path.start(place(v.mesh, rest, {element_at(v, rest, 0, row, direction(0.0)), Vec3(0, 0, kDeep)}) + kTail * up);
    sew(v, rest, 0, row, direction(turn), path, passes);
    sew(v, rest, 1, row, direction(turn), path, passes);
    const double next = turn + 0.5 / stitches;
    path.to(middle + 1.3 * v.radius * direction(k + 1 < stitches ? next : turn), kSewnEdge);
    // more than half a quarter of the way round is led round, not through the lumen
    for (int j = 1; k + 1 < stitches && stitches < 4 && j < 4; ++j) path.to(middle + 1.3 * v.radius * direction(next + 0.125 * j / stitches), kSewnEdge);
  }
  path.to(middle + 4.0 * v.radius * up, kFreeEdge);
  path.to(of->thread_path.col(of->thread_path.cols() - 1), kFreeEdge);
  auto model = std::make_shared<Model>(*of);
  model->thread_path = path.points();
  model->description.capacity = static_cast<int>(2 * model->thread_path.cols());
  State s = World(model).state();
  s.tissue.tracks.n = static_cast<std::int32_t>(passes.size());
  for (std::size_t k = 0; k < passes.size(); ++k) s.tissue.tracks.tracks[k] = track_of(passes[k], path.length(), of->needle->shape.wire_radius);
  return {model, s};
}

void run_sewn_bench(int stitches, BenchResult& r, const StepTimer& timer, const TaskOpener& open_task) {
  const auto [model, state] = sewn_stumps(open_task("vessel-stitch").model, stitches);
  World world(model);
  world.restore(state);
  r.dt_ms = 1e3 * world.description().dt;
  for (int k = 0; k < kSettle; ++k) world.step(Inputs{});
  timer(
      r, [&] { world.step(Inputs{}); },
      [&] {
        const Observation& o = world.observation();
        r.nodes = std::max(r.nodes, o.n_nodes + o.tissue.n);
        r.contacts = std::max(r.contacts, o.n_contacts + o.tissue.n_passes);
      });
}

}  // namespace filum
