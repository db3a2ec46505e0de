#include "evidence/bench.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <thread>

#include "base/stage_clock.h"
#include "evidence/brain_bench.h"
#include "evidence/name_choice.h"
#include "evidence/percentile.h"
#include "evidence/pulled_knot.h"
#include "evidence/sewn_bench.h"
#include "evidence/stitch_bench.h"
#include "evidence/timing.h"
#include "evidence/vessel_bench.h"

namespace filum {
namespace {

/// Fixed work that depends on the machine alone.
class Reference {
 public:
  Reference() : matrix_(kSize, kSize), solver_(kSize) {
    for (int i = 0; i < kSize; ++i)
      for (int j = 0; j < kSize; ++j) matrix_(i, j) = 1.0 / (1.0 + std::abs(i - j)) + (i == j ? 2.0 : 0.0);
  }
  void run() {
    const auto begin = Clock::now();
    solver_.compute(matrix_);
    ms_.push_back(milliseconds_since(begin));
  }
  double p50() const { return percentile(ms_, 0.5); }
  static constexpr const char* kName = "dense Cholesky 240 x 240";

 private:
  static constexpr int kSize = 240;
  Eigen::MatrixXd matrix_;
  Eigen::LLT<Eigen::MatrixXd> solver_;
  std::vector<double> ms_;
};

/// Times of the stages of many steps.
class StageTimes {
 public:
  explicit StageTimes(std::size_t steps) : steps_(steps) {}
  void note() {
    std::size_t k = 0;
    for (const StageClock::Stage& s : clock_) {
      if (k == ms_.size()) {
        names_.push_back(s.name);
        ms_.emplace_back().reserve(steps_);
        ms_.back().assign(noted_, 0.0);
      }
      ms_[k++].push_back(s.milliseconds);
    }
    ++noted_;
    clock_.clear();
  }
  std::vector<std::pair<std::string, double>> p50() const {
    std::vector<std::pair<std::string, double>> list;
    for (std::size_t k = 0; k < ms_.size(); ++k) list.emplace_back(names_[k], percentile(ms_[k], 0.5));
    return list;
  }
  /// Mean of the steps whose `ms` is at least `least`.
  std::vector<std::pair<std::string, double>> mean(const std::vector<double>& ms, double least) const {
    std::vector<std::pair<std::string, double>> list;
    for (std::size_t k = 0; k < ms_.size(); ++k) {
      double sum = 0.0;
      int count = 0;
      for (std::size_t i = 0; i < std::min(ms.size(), ms_[k].size()); ++i)
        if (ms[i] >= least) sum += ms_[k][i], ++count;
      list.emplace_back(names_[k], sum / std::max(1, count));
    }
    return list;
  }

 private:
  std::size_t steps_, noted_ = 0;
  StageClock clock_;
  std::vector<std::string> names_;
  std::vector<std::vector<double>> ms_;
};

/// Times `step` again and again, r.steps times at most and while `look`, which follows each step and is not timed, returns true; with the
/// reference in between.
template <class Step, class Look>
void time_steps(BenchResult& r, Step step, Look look) {
  constexpr int kReferenceEvery = 40;
  Reference reference;
  std::vector<double> ms, processor;
  ms.reserve(static_cast<std::size_t>(r.steps));
  processor.reserve(static_cast<std::size_t>(r.steps));
  StageTimes stages(static_cast<std::size_t>(r.steps));
  double total = 0.0;
  for (bool more = true; more && static_cast<int>(ms.size()) < r.steps;) {
    if (ms.size() % kReferenceEvery == 0) reference.run();
    const double processor_begin = processor_ms();
    const auto begin = Clock::now();
    step();
    ms.push_back(milliseconds_since(begin));
    processor.push_back(processor_ms() - processor_begin);
    total += ms.back();
    stages.note();
    more = look();
  }
  r.steps = static_cast<int>(ms.size());
  r.p50_ms = percentile(ms, 0.5);
  r.p99_ms = percentile(ms, 0.99);
  r.max_ms = percentile(ms, 1.0);
  r.real_time_factor = r.dt_ms * r.steps / total;
  r.processor_p50_ms = percentile(processor, 0.5);
  r.processor_p99_ms = percentile(processor, 0.99);
  for (const double t : processor) r.processor_mean_ms += t / static_cast<double>(processor.size());
  r.step_ms = ms;
  r.stages = stages.p50();
  r.slow_stages = stages.mean(processor, r.processor_p99_ms);
  r.reference_name = Reference::kName;
  r.reference_p50_ms = reference.p50();
}

/// 20 mm of 10-0 nylon (30 um, 2.5 GPa, 1140 kg/m3), clamped level at one end, falls and swings.
void bench_hanging(BenchResult& r) {
  RodMaterial wire = RodMaterial::round_wire(15e-6, 2.5e9, 0.35, 1140.0);
  RodProbe probe(wire, nodes_on_x(r.nodes, 0.0, 20e-3 / (r.nodes - 1)));
  probe.rod.self_contact = true;
  probe.hold(0);
  probe.hold_position(1);
  probe.options = RodStepOptions();
  probe.options.dt = 1e-3 * r.dt_ms;
  time_steps(
      r, [&] { probe.rod.step(probe.state, probe.memory, probe.options); }, [] { return true; });
}

void bench_knot(BenchResult& r) {
  PulledKnot knot(r.nodes, 0.3, 1e-3 * r.dt_ms);
  const double radius = knot.probe.rod.material.radius;
  time_steps(
      r, [&] { knot.pull(0.03); },
      [&] {
        r.contacts = std::max(r.contacts, knot.probe.rod.contact().n_touching(radius));
        return true;
      });
}

/// Two strands of half the nodes each, twisted together as a rope of any length is, and shaken sideways in waves of 24 diameters: as many contacts as
/// nodes, the same motion everywhere, and nothing else that grows.
void bench_rope(BenchResult& r) {
  constexpr double kRadius = 1.6e-3, kPitch = 24.0 * kRadius;
  const int each = r.nodes / 2;
  Points x(3, r.nodes);
  for (int i = 0; i < r.nodes; ++i) {
    const double along = 2.0 * kRadius * (i < each ? i : r.nodes - 1 - i);  // there and back
    const double turn = 2.0 * std::numbers::pi * along / kPitch + (i < each ? 0.0 : std::numbers::pi);
    x.col(i) = Vec3(along, 1.02 * kRadius * std::cos(turn), 1.02 * kRadius * std::sin(turn));
  }
  RodMaterial m = RodMaterial::round_wire(kRadius, 0.18e6, 0.5, 1180.0);
  m.drag = 1e-3;
  RodProbe probe(m, x);
  probe.state.alive[each - 1] = 0;
  probe.rod.self_contact = true;
  probe.rod.contact_material = {.stiffness = 200.0, .friction = 0.3, .presliding = 0.05 * kRadius};
  probe.options = RodStepOptions();
  probe.options.dt = 1e-3 * r.dt_ms;
  probe.options.gravity.setZero();
  probe.options.force_tolerance = 1e-6;
  for (int i : {0, 1, each - 2, each - 1, each, each + 1, r.nodes - 2, r.nodes - 1}) probe.hold(i);
  constexpr double kShake = 2e-4;  // [N], on a node
  int k = 0;
  time_steps(
      r,
      [&] {
        const double now = kShake * std::sin(2.0 * std::numbers::pi * 20.0 * probe.options.dt * ++k);
        for (int i = 0; i < r.nodes; ++i) probe.rod.boundary.load(2, i) = now * std::sin(2.0 * std::numbers::pi * x(0, i) / (48.0 * kRadius));
        probe.rod.step(probe.state, probe.memory, probe.options);
      },
      [&] {
        r.contacts = std::max(r.contacts, probe.rod.contact().n_touching(kRadius));
        return true;
      });
}

void bench_task(BenchResult& r, const std::string& task, const TaskOpener& open_task) {
  const DrivenTask driven = open_task(task);
  World world(driven.model);
  r.dt_ms = 1e3 * world.description().dt;
  Inputs inputs = driven.inputs(world);
  time_steps(
      r, [&] { world.step(inputs); },
      [&] {
        r.nodes = std::max(r.nodes, world.observation().n_nodes);
        r.contacts = std::max(r.contacts, world.observation().n_contacts);
        inputs = driven.inputs(world);
        return !driven.over();
      });
}

/// What steps at a fixed rate took; each begins when it is due or, if that is past, at once.
struct Paced {
  std::vector<double> ms;
  int overruns = 0;  // ended after the next one was due
};

template <class Step, class Look>
Paced run_paced(double dt_ms, int steps, Step step, Look look) {
  Paced paced;
  auto due = Clock::now();
  for (int k = 0; k < steps; ++k) {
    std::this_thread::sleep_until(due);
    const auto begin = Clock::now();
    step();
    paced.ms.push_back(milliseconds_since(begin));
    look();
    due = std::max(due, begin) + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double, std::milli>(dt_ms));
    if (Clock::now() > due) ++paced.overruns;
  }
  return paced;
}

/// A brain of 10,800 nodes at 100 Hz, and on another thread needle, thread and vessel at 500 Hz.
void bench_classroom(BenchResult& r, const TaskOpener& open_task) {
  constexpr const char* kSuture = "vessel-stitch";
  const DrivenTask driven = open_task(kSuture);
  World world(driven.model);
  Inputs inputs = driven.inputs(world);
  const auto brain = pressed_block();
  const double dt_ms = 1e3 * world.description().dt;
  Reference reference;
  for (int k = 0; k < 10; ++k) reference.run();
  Paced suture;
  std::thread other([&] {
    suture = run_paced(dt_ms, static_cast<int>(r.steps * r.dt_ms / dt_ms), [&] { world.step(inputs); }, [&] { inputs = driven.inputs(world); });
  });
  const auto begin = Clock::now();
  const Paced own = run_paced(r.dt_ms, r.steps, brain, [] {});
  r.real_time_factor = r.dt_ms * r.steps / milliseconds_since(begin);
  other.join();
  r.p50_ms = percentile(own.ms, 0.5);
  r.p99_ms = percentile(own.ms, 0.99);
  r.max_ms = percentile(own.ms, 1.0);
  r.stages = {{"brain: overruns (number)", own.overruns},
              {"vessel-stitch: steps (number)", static_cast<double>(suture.ms.size())},
              {"vessel-stitch: p50", percentile(suture.ms, 0.5)},
              {"vessel-stitch: p99", percentile(suture.ms, 0.99)},
              {"vessel-stitch: overruns (number)", suture.overruns}};
  r.reference_name = Reference::kName;
  r.reference_p50_ms = reference.p50();
}

struct Bench {
  BenchResult stated;
  std::function<void(BenchResult&, const TaskOpener&)> run;
  int passes = 1;  // over the same bits
};

std::vector<Bench> all_benches() {
  const auto stated = [](const char* name, int nodes, int steps) {
    BenchResult r;
    r.name = name;
    r.nodes = nodes;
    r.dt_ms = 1.0;
    r.steps = steps;
    return r;
  };
  const auto hanging = [](BenchResult& r, const TaskOpener&) { bench_hanging(r); };
  const auto knot = [](BenchResult& r, const TaskOpener&) { bench_knot(r); };
  const auto rope = [](BenchResult& r, const TaskOpener&) { bench_rope(r); };
  const auto task = [](const char* name) {
    return [name](BenchResult& r, const TaskOpener& open) { bench_task(r, name, open); };
  };
  constexpr int kWholeTask = 100'000;  // steps, at most
  constexpr int kPasses = 3;
  std::vector<Bench> list = {{stated("rod-100", 100, 2000), hanging},
                             {stated("knot-101", 101, 8000), knot},
                             {stated("knot-301", 301, 8000), knot},
                             {stated("task-knot-square", 0, kWholeTask), task("knot-square")},
                             {stated("task-knot-surgeons", 0, kWholeTask), task("knot-surgeons")}};
  for (const int n : {50, 100, 200, 400, 800}) {
    list.push_back({stated(("scaling-" + std::to_string(n)).c_str(), n, 500), hanging});
    list.push_back({stated(("rope-" + std::to_string(n)).c_str(), n, 500), rope});
  }
  const auto timer = [](BenchResult& r, const std::function<void()>& step, const std::function<void()>& look) {
    time_steps(r, step, [&look] {
      look();
      return true;
    });
  };
  for (auto& [r, run] : brain_benches())
    list.push_back({r, [run = run, timer](BenchResult& result, const TaskOpener&) { run(result, timer); }});
  for (auto& [r, run] : vessel_benches())
    list.push_back({r, [run = run, timer](BenchResult& result, const TaskOpener&) { run(result, timer); }});
  for (const StitchBench& b : stitch_benches())
    list.push_back({stated(b.name, 0, 0), [b, timer](BenchResult& r, const TaskOpener& open) { run_stitch_bench(b, r, timer, open); }, kPasses});
  for (const int n : kSewn)
    list.push_back({stated(("stitches-" + std::to_string(n)).c_str(), 0, 1000), [n, timer](BenchResult& r, const TaskOpener& open) { run_sewn_bench(n, r, timer, open); }});
  list.push_back({stated("classroom", 10800, 500), bench_classroom});
  list.back().stated.dt_ms = 10.0;
  return list;
}

}  // namespace

std::vector<std::string> bench_names() {
  std::vector<std::string> names;
  for (const Bench& b : all_benches()) names.push_back(b.stated.name);
  return names;
}

std::vector<BenchResult> run_benches(const std::vector<std::string>& names, const TaskOpener& open_task,
                                     const BenchProgress& progress) {
  check_names("bench", names, bench_names());
  std::vector<BenchResult> results;
  for (const Bench& b : all_benches()) {
    if (!is_wanted(names, b.stated.name)) continue;
    BenchResult r = b.stated;
    b.run(r, open_task);
    std::vector<std::vector<double>> passes = {r.step_ms};
    while (static_cast<int>(passes.size()) < b.passes) {
      BenchResult again = b.stated;
      b.run(again, open_task);
      passes.push_back(std::move(again.step_ms));
    }
    if (b.passes > 1) r.undisturbed = undisturbed(passes);
    if (progress) progress(r);
    results.push_back(std::move(r));
  }
  return results;
}

std::string machine_text() {
  std::ifstream stream("/proc/cpuinfo");
  std::string text = "unknown processor";
  for (std::string line; std::getline(stream, line);) {
    if (!line.starts_with("model name")) continue;
    text = line.substr(std::min(line.size(), line.find(':') + 2));
    break;
  }
  return text.append(", ").append(std::to_string(std::thread::hardware_concurrency())).append(" cores");
}

}  // namespace filum
