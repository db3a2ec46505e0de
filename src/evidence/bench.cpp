#include "evidence/bench.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <thread>

#include "evidence/brain_bench.h"
#include "evidence/name_choice.h"
#include "evidence/pulled_knot.h"
#include "evidence/vessel_bench.h"

namespace filum {
namespace {

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

double percentile(std::vector<double> values, double fraction) {
  std::sort(values.begin(), values.end());
  return values[std::min(values.size() - 1,
                         static_cast<std::size_t>(fraction * static_cast<double>(values.size())))];
}

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

/// Times `step` again and again with the reference in between; `look` follows each step and is not timed.
template <class Step, class Look>
void time_steps(BenchResult& r, Step step, Look look) {
  constexpr int kReferenceEvery = 40;
  Reference reference;
  std::vector<double> ms;
  ms.reserve(static_cast<std::size_t>(r.steps));
  double total = 0.0;
  for (int k = 0; k < r.steps; ++k) {
    if (k % kReferenceEvery == 0) reference.run();
    const auto begin = Clock::now();
    step();
    ms.push_back(milliseconds_since(begin));
    total += ms.back();
    look();
  }
  r.p50_ms = percentile(ms, 0.5);
  r.p99_ms = percentile(ms, 0.99);
  r.max_ms = percentile(ms, 1.0);
  r.real_time_factor = r.dt_ms * r.steps / total;
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
      r, [&] { probe.rod.step(probe.state, probe.memory, probe.options); }, [] {});
}

void bench_knot(BenchResult& r) {
  PulledKnot knot(r.nodes, 0.3, 1e-3 * r.dt_ms);
  const double radius = knot.probe.rod.material.radius;
  time_steps(
      r, [&] { knot.pull(0.03); },
      [&] { r.contacts = std::max(r.contacts, knot.probe.rod.contact().n_touching(radius)); });
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
      });
}

struct Bench {
  BenchResult stated;
  std::function<void(BenchResult&, const TaskOpener&)> run;
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
  const auto square = [](BenchResult& r, const TaskOpener& open) { bench_task(r, "knot-square", open); };
  std::vector<Bench> list = {{stated("rod-100", 100, 2000), hanging},    {stated("knot-101", 101, 8000), knot},
          {stated("knot-301", 301, 8000), knot},      {stated("task-knot-square", 0, 5000), square},
          {stated("scaling-50", 50, 500), hanging},   {stated("scaling-100", 100, 500), hanging},
          {stated("scaling-200", 200, 500), hanging}, {stated("scaling-400", 400, 500), hanging},
          {stated("scaling-800", 800, 500), hanging}};
  const auto timer = [](BenchResult& r, const std::function<void()>& step, const std::function<void()>& look) { time_steps(r, step, look); };
  for (auto& [r, run] : brain_benches())
    list.push_back({r, [run = run, timer](BenchResult& result, const TaskOpener&) { run(result, timer); }});
  for (auto& [r, run] : vessel_benches())
    list.push_back({r, [run = run, timer](BenchResult& result, const TaskOpener&) { run(result, timer); }});
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
