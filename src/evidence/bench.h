#pragma once
// Timings of single time steps, each next to a fixed reference workload timed in the same process, so that
// ratios can be compared between machines and between busy and idle ones.

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "evidence/undisturbed.h"
#include "world/inputs.h"
#include "world/world.h"

namespace filum {

struct BenchResult {
  std::string name;
  int nodes = 0, contacts = 0;  // contacts: most at a time
  double dt_ms = 0.0;
  int steps = 0;
  double p50_ms = 0.0, p99_ms = 0.0, max_ms = 0.0;
  double real_time_factor = 0.0;                       // scene time over time spent in steps
  std::vector<double> step_ms;                         // of every step
  Undisturbed undisturbed;                             // taken of the steps that sew
  double processor_p50_ms = 0.0, processor_p99_ms = 0.0, processor_mean_ms = 0.0;  // of the step's thread alone; 0 where not taken
  std::vector<std::pair<std::string, double>> stages;  // p50 [ms] of each part of the step
  std::vector<std::pair<std::string, double>> slow_stages;  // mean [ms] of each part over the slowest hundredth of the steps
  std::string reference_name;
  double reference_p50_ms = 0.0;
};

/// A task and the hands that do it, for the task benches: asked only when one is run.
struct DrivenTask {
  std::shared_ptr<const Model> model;
  std::function<Inputs(const World&)> inputs;  // for the next step
  std::function<bool()> over;                  // true once the hands have done all they do
};
using TaskOpener = std::function<DrivenTask(const std::string& task)>;
using BenchProgress = std::function<void(const BenchResult&)>;

std::vector<std::string> bench_names();

/// Runs the benches named (all if `names` is empty); a name also stands for every bench that begins with it
/// and a hyphen. Throws InputError for a name that is none.
std::vector<BenchResult> run_benches(const std::vector<std::string>& names, const TaskOpener& open_task,
                                     const BenchProgress& progress = {});

/// Processor and cores of this machine.
std::string machine_text();

}  // namespace filum
