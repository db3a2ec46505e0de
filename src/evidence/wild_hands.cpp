#include "evidence/wild_hands.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <string_view>

#include "evidence/wall_watch.h"
#include "world/model.h"
#include "world/state.h"

namespace filum {
namespace {

constexpr double kRound = 3e-3;     // [m], how far from what is aimed at
constexpr double kReach = 60e-3;     // [m], of hands, as the pointer's
constexpr double kFarthest = 0.5;   // [m], from where the scene is: what blows up goes further
constexpr double kFastest = 20.0;   // [m/s]: a 10-0 thread stretched to its strength and let go stays below
constexpr double kSwage = 20e-6;    // [m], between thread and needle
constexpr int kMostApart = 5;       // steps: while a snapped thread breaks, steps whose solver reports trouble leave more
constexpr int kMostBuried = 25;     // steps, 50 ms: what is drawn taut over a rim, or that a wall is flung upon, is out again after ten

bool finite(const Points& x) { return x.allFinite(); }

std::string fault_of(const State& s, const Observation& o) {
  if (!s.needle.X_WN.finite() || !s.needle.v.allFinite()) return "the needle is not finite";
  if (s.thread.n > 0 && !(finite(s.thread.x.leftCols(s.thread.n)) && finite(s.thread.v.leftCols(s.thread.n)))) return "the thread is not finite";
  if (!finite(s.tissue.wall.x) || !finite(s.tissue.wall.v)) return "the tissue is not finite";
  if (!finite(o.brain.positions)) return "the brain is not finite";
  for (const InstrumentState& i : s.instruments)
    if (!i.X_WT.finite() || !i.v.allFinite()) return "an instrument is not finite";
  for (int i = 0; i < o.n_tools; ++i)
    if (!o.tools[static_cast<std::size_t>(i)].X_WT.finite() || !o.tools[static_cast<std::size_t>(i)].f_T_W.allFinite()) return "what a tool feels is not finite";
  if (s.thread.n > 0 && s.thread.x.leftCols(s.thread.n).cwiseAbs().maxCoeff() > kFarthest) return "the thread flew away";
  if (s.tissue.wall.x.size() > 0 && s.tissue.wall.x.cwiseAbs().maxCoeff() > kFarthest) return "the tissue flew away";
  return "";
}

bool apart(const State& s, const Observation& o) { return s.has_needle != 0 && (o.positions.col(o.n_nodes - 1) - o.needle.swage_W).norm() > kSwage; }

/// In words, where one has been in the tissue for too long.
std::string buried_in(const BuriedStrand& b) {
  if (b.steps <= kMostBuried) return "";
  std::array<char, 160> text;
  std::snprintf(text.data(), text.size(), "%s, %.2f mm from the swage, is %.0f um deep in the tissue without a track, %d steps on end", b.strand < 0.0 ? "the thread" : "the needle",
                1e3 * std::abs(b.strand), 1e6 * b.depth, b.steps);
  return text.data();
}

double fastest_of(const State& s) {
  double fastest = s.needle.v.norm();
  if (s.thread.n > 0) fastest = std::max(fastest, s.thread.v.leftCols(s.thread.n).colwise().norm().maxCoeff());
  if (s.tissue.wall.v.size() > 0) fastest = std::max(fastest, s.tissue.wall.v.colwise().norm().maxCoeff());
  return fastest;
}

}  // namespace

WildHands::WildHands(std::uint64_t seed, const SceneDescription& scene) : rng_(seed), dt_(scene.dt), n_tools_(scene.n_tools) {}

/// Near a node of the thread, a place of the tissue or brain, or an object, whichever the dice say.
Vec3 WildHands::somewhere(const Observation& o) {
  std::array<Vec3, 4> places;
  std::size_t n = 0;
  const auto any = [&](const Points& x, int count) { return Vec3(x.col(static_cast<Eigen::Index>(rng_.below(static_cast<std::uint64_t>(count))))); };
  if (o.n_nodes > 0) places[n++] = any(o.positions, o.n_nodes);
  if (o.tissue.n > 0) places[n++] = any(o.tissue.positions, o.tissue.n);
  if (o.brain.positions.cols() > 0) places[n++] = any(o.brain.positions, static_cast<int>(o.brain.positions.cols()));
  if (o.n_pellets > 0) places[n++] = o.pellets[rng_.below(static_cast<std::uint64_t>(o.n_pellets))].p_W;
  const Vec3 at = n > 0 ? places[rng_.below(n)] : Vec3(0, 0, 0);
  return at + kRound * rng_.uniform() * rng_.direction();
}

void WildHands::aim(Hand& hand, const Observation& o) {
  hand.from = hand.to;
  hand.to.p = somewhere(o);
  if ((hand.to.p - hand.from.p).norm() > 30e-3) hand.to.p = hand.from.p + 30e-3 * (hand.to.p - hand.from.p).normalized();  // a thread that flies is not chased
  for (int c = 0; c < 3; ++c) hand.to.p[c] = std::clamp(hand.to.p[c], -kReach, kReach);  // else hands and what they drag along wander off in minutes
  if (rng_.uniform() < 0.5) hand.to.q = rng_.rotation();
  const double speed = rng_.uniform(0.1, 1.0) * kWildSpeed;
  hand.steps = hand.left = std::max(1, static_cast<int>((hand.to.p - hand.from.p).norm() / (speed * dt_)));
  hand.grip = rng_.uniform() < 0.5 ? 0.2 : -0.1;
  hand.buttons = rng_.uniform() < 0.2 ? static_cast<std::uint32_t>(rng_.below(64)) : 0;  // any of the six of world/inputs.h
  hand.silent = rng_.uniform() < 0.05 ? 60 : 0;
}

Inputs WildHands::next(const Observation& o) {
  Inputs in;
  for (int i = 0; i < n_tools_; ++i) {
    Hand& hand = hands_[static_cast<std::size_t>(i)];
    if (!started_) hand.from = hand.to = o.tools[static_cast<std::size_t>(i)].X_WT;
    if (hand.left == 0) aim(hand, o);
    --hand.left;
    const double f = 1.0 - static_cast<double>(hand.left) / hand.steps;
    ToolInput& t = in.tools[static_cast<std::size_t>(i)];
    t.X_WD = {(1.0 - f) * hand.from.p + f * hand.to.p, hand.from.q.slerp(f, hand.to.q)};
    t.grip_angle = hand.grip;
    t.buttons = hand.buttons;
    t.valid = hand.silent == 0;
    if (hand.silent > 0) --hand.silent;
  }
  started_ = true;
  return in;
}

WildRun run_wild(World& world, const State& first, std::uint64_t seed, int steps, const WildProgress& progress) {
  world.restore(first);
  WildHands hands(seed, world.description());
  WallWatch watch(world.model());
  WildRun run;
  run.seed = seed;
  int apart_for = 0;  // steps
  const double dt_ms = 1e3 * world.description().dt;
  while (run.fault.empty() && run.steps < static_cast<std::uint64_t>(steps)) {
    const Inputs inputs = hands.next(world.observation());
    const auto begin = std::chrono::steady_clock::now();
    world.step(inputs);
    const double took = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
    ++run.steps;
    run.slowest_ms = std::max(run.slowest_ms, took);
    run.late += took > dt_ms ? 1 : 0;
    const Observation& o = world.observation();
    const std::uint64_t before = run.trouble;
    for (int k = 0; k < o.n_events; ++k) run.trouble += std::string_view(o.events[static_cast<std::size_t>(k)].name) == "solver-trouble" ? 1 : 0;
    run.fault = fault_of(world.state(), o);
    apart_for = apart(world.state(), o) ? apart_for + 1 : 0;
    run.apart = std::max(run.apart, apart_for);
    if (run.fault.empty() && (apart_for > kMostApart || (apart_for > 0 && run.trouble == before))) run.fault = "thread and needle came apart";
    if (run.fault.empty()) watch.look(world.state());
    run.buried = std::max(run.buried, watch.longest().steps);
    if (run.fault.empty()) run.fault = buried_in(watch.longest());
    run.fastest = std::max(run.fastest, fastest_of(world.state()));
    if (o.radius > 0.0 && o.n_contacts > 0) run.deepest = std::max(run.deepest, -o.min_gap / (2.0 * o.radius));
    if (run.fault.empty() && run.fastest > kFastest) run.fault = "something moves faster than hands and thread can make it";
    if (run.fault.empty() && run.deepest > 0.95) run.fault = "strands are through each other";
    if (progress && run.steps % kWildTold == 0) progress(run);
  }
  return run;
}

}  // namespace filum
