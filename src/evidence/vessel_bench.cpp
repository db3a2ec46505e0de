#include "evidence/vessel_bench.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <tuple>

#include "evidence/percentile.h"
#include "evidence/timing.h"
#include "evidence/vessel_probe.h"
#include "physics/vessel_clamp.h"
#include "physics/vessel_wall.h"

namespace filum {
namespace {

constexpr double kElement = 0.12e-3;  // [m], along

/// Two stumps of a rat femoral artery (models/vessel/rat-femoral-artery.yaml without its opening angle).
VesselMesh stumps(int around, int along, double length) {
  TubeShape s;
  s.inner_radius = 0.26e-3;
  s.thickness = 90e-6;
  s.around = around;
  s.along = along;
  s.length = length;
  return make_stumps(s, {});
}

/// A stitch is drawn to and fro through both edges (three material points through each wall, 400 N/m), forceps drag at the other side of the first stump
/// with at most 0.05 mN (0.4 mN draw its edge out by more than half its length: it wrinkles, and how is the mesh's). In a fine mesh each of them takes as much of
/// the wall as in a coarse one: loads at single points of ever smaller elements would be other loads.
class Handling {
 public:
  Handling(VesselWall& wall, WallState& state, int around, int along) : wall_(wall), state_(state), side_(std::max(1, static_cast<int>(std::lround(around / kCoarse)))) {
    const int edge = (along - 1) * around, other = wall.mesh().n_elements() / 2;
    const auto patch = [&](int first, int middle, double eta, double zeta, std::vector<WallPoint>& list) {
      for (int row = 0; row < side_; ++row)
        for (int k = 0; k < side_; ++k) list.push_back({first + edge - row * around + (middle + k - side_ / 2 + around) % around, Vec3(0, eta, zeta)});
    };
    for (const int first : {0, other})
      for (const double zeta : {-0.7, 0.0, 0.7}) patch(first, around / 4, -0.5, zeta, knots_);
    patch(0, 3 * around / 4, 0.0, 1.0, pressed_);
    for (const WallPoint& k : knots_) start_.push_back(wall.position(state, k));
  }
  void load(int step) {
    wall_.clear_loads();
    const double t = 2e-3 * step, pull = 0.1e-3 * (1.0 - std::cos(6.0 * t)), share = 1.0 / (side_ * side_);
    for (std::size_t k = 0; k < knots_.size(); ++k) {
      const Vec3 goal = start_[k] + pull * Vec3(0.3 * std::sin(2.0 * t), 1.0, 0.0);
      wall_.add_load(state_, knots_[k], share * 400.0 * (goal - wall_.position(state_, knots_[k])), share * 400.0);
    }
    for (const WallPoint& p : pressed_) wall_.add_load(state_, p, Vec3(0, share * 2.5e-5 * (1.0 - std::cos(5.0 * t)), 0));
  }

 private:
  static constexpr double kCoarse = 24.0;  // elements around of the mesh whose element each load takes
  VesselWall& wall_;
  WallState& state_;
  int side_;  // elements along and around that each load is spread over
  std::vector<WallPoint> knots_, pressed_;
  std::vector<Vec3> start_;
};

void bench_stumps(BenchResult& r, const StepTimer& timer, int around, int along, double length) {
  WallOptions options;
  options.dt = 1e-3 * r.dt_ms;
  VesselWall wall(stumps(around, along, length), bench_artery(), options);
  WallState state = wall.first_state();
  Handling handling(wall, state, around, along);
  r.nodes = static_cast<int>(state.x.cols());
  std::vector<double> refit, forces;
  double solving = 0.0, solved = 0.0;  // [ms], iterations: of all steps that made some
  int k = 0, missed = 0;
  const auto ms = [](Clock::time_point a) { return std::chrono::duration<double, std::milli>(Clock::now() - a).count(); };
  Points scratch = Points::Zero(3, state.x.cols());
  WallSummary summary;
  timer(
      r,
      [&] {
        handling.load(k++);
        const auto begin = Clock::now();
        summary = wall.step(state);
        if (summary.iterations == 0) return;
        solving += ms(begin);
        solved += summary.iterations;
      },
      [&] {
        missed += summary.converged ? 0 : 1;
        auto begin = Clock::now();
        wall.refit(state);
        refit.push_back(ms(begin));
        begin = Clock::now();
        wall.elements().add_forces(state.x, state.soundness, scratch);
        forces.push_back(ms(begin));
      });
  r.contacts = 7;
  r.stages = {{"forces of the elements, once", median(forces)},
              {"boxes of the surface", median(refit)},
              {"an iteration, in steps that make some", solving / std::max(1.0, solved)},
              {"iterations (mean number)", solved / k},
              {"steps short of the tolerance (share)", static_cast<double>(missed) / k}};
}

}  // namespace

std::vector<WallLayer> bench_artery() {
  WallLaw intima, media;
  intima.kind = WallLaw::Kind::neo_hookean;
  intima.mu = 30e3;
  intima.lambda = 2e6;
  media = intima;
  media.kind = WallLaw::Kind::fibres;
  media.k1 = 30e3;
  media.k2 = 0.84;
  media.beta = 29.0 * std::numbers::pi / 180.0;
  WallLaw adventitia = media;
  adventitia.mu = 5e3;
  adventitia.k1 = 10e3;
  adventitia.k2 = 0.71;
  adventitia.beta = 62.0 * std::numbers::pi / 180.0;
  return {{"intima", 6e-6, intima}, {"media", 52e-6, media}, {"adventitia", 32e-6, adventitia}};
}

std::vector<std::pair<BenchResult, TimedBench>> vessel_benches() {
  std::vector<std::pair<BenchResult, TimedBench>> list;
  const auto add = [&](const std::string& name, int steps, int around, int along, double length) {
    BenchResult r;
    r.name = name;
    r.dt_ms = 2.0;
    r.steps = steps;
    list.emplace_back(r, [around, along, length](BenchResult& result, const StepTimer& t) { bench_stumps(result, t, around, along, length); });
  };
  add("vessel-wall-168", 2000, 14, 2, 2 * kElement);
  add("vessel-wall-1536", 2000, 24, 15, 15 * kElement);
  for (const auto& [name, along] : {std::pair("vessel-scaling-400", 3), {"vessel-scaling-800", 7}, {"vessel-scaling-1500", 15},
                                    {"vessel-scaling-3000", 30}, {"vessel-scaling-6000", 61}, {"vessel-scaling-12000", 124}})
    add(name, 300, 24, along, along * kElement);
  for (const auto& [name, around, along] : {std::tuple("vessel-refined-200", 9, 5), {"vessel-refined-400", 12, 7}, {"vessel-refined-800", 17, 10}, {"vessel-refined-1500", 24, 15},
                                            {"vessel-refined-3000", 34, 21}, {"vessel-refined-6000", 48, 30}, {"vessel-refined-12000", 68, 43}})
    add(name, 300, around, along, 15 * kElement);
  return list;
}

}  // namespace filum
