// filum bench: how long the time steps take on this machine.

#include "evidence/bench.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/error.h"
#include "cli/driven_task.h"
#include "cli/number_range.h"
#include "cli/options.h"
#include "cli/setup.h"
#include "evidence/sewn_bench.h"
#include "evidence/wild_hands.h"
#include "world/model.h"
#include "world/state.h"
#include "world/vessel_model.h"

namespace filum {
namespace {

constexpr const char* kTaskBench = "task-";

struct BenchOptions {
  CommonOptions common;
  std::vector<std::string> names;
  int wild = 0;              // seeds of violent hands instead of benches
  int wild_first = 1;        // seed of the first
  double wild_seconds = 0.6;  // [s], scene time of each
  int wild_sewn = 0;          // stitches by construction that they find in a vessel
};

/// One task of every kind of scene.
const std::vector<std::string> kWildTasks = {"knot-square", "needle-loading", "card-stitches", "vessel-stitch", "grasp-transfer", "press-to-target"};

/// All benches but those of tasks that have no demonstration, which are named on stderr.
std::vector<std::string> possible_benches(const std::string& root, const Streams& io) {
  std::vector<std::string> names;
  for (const std::string& name : bench_names()) {
    std::string task = name.starts_with(kTaskBench) ? name.substr(std::string(kTaskBench).size()) : "";
    if (task == "anastomosis" || name == "seed-vessel") task = "vessel-stitch";  // evidence/stitch_bench.h
    if (task.empty() || std::filesystem::exists(demonstration_file(root, task))) {
      names.push_back(name);
    } else {
      std::fprintf(io.err, "filum: %s is left out: %s does not exist\n", name.c_str(),
                   demonstration_file(root, task).c_str());
    }
  }
  return names;
}

nlohmann::ordered_json json_of(const BenchResult& r) {
  using Json = nlohmann::ordered_json;
  Json stages = Json::object(), slow = Json::object();
  for (const auto& [name, ms] : r.stages) stages[name] = ms;
  for (const auto& [name, ms] : r.slow_stages) slow[name] = ms;
  Json json = {{"name", r.name},
          {"nodes", r.nodes},
          {"contacts", r.contacts},
          {"dt_ms", r.dt_ms},
          {"steps", r.steps},
          {"p50_ms", r.p50_ms},
          {"p99_ms", r.p99_ms},
          {"max_ms", r.max_ms},
          {"real_time_factor", r.real_time_factor},
          {"processor", {{"p50_ms", r.processor_p50_ms}, {"p99_ms", r.processor_p99_ms}, {"mean_ms", r.processor_mean_ms}}},
          {"stages", stages},
          {"stages_of_slowest_hundredth", slow},
          {"reference", {{"name", r.reference_name}, {"p50_ms", r.reference_p50_ms}}}};
  const Undisturbed& u = r.undisturbed;
  if (u.passes > 0) json["undisturbed"] = {{"passes", u.passes}, {"p50_ms", u.p50_ms}, {"p99_ms", u.p99_ms}, {"max_ms", u.max_ms}};
  return json;
}

void print_line(const BenchResult& r, const Streams& io) {
  std::fprintf(io.out, "%-18s %5d %8d %6.2f %6d %8.3f %8.3f %8.3f %9.2f %12.3f %8.2f\n", r.name.c_str(), r.nodes,
              r.contacts, r.dt_ms, r.steps, r.p50_ms, r.p99_ms, r.max_ms, r.real_time_factor,
              r.reference_p50_ms, r.p50_ms / r.reference_p50_ms);
  if (r.processor_mean_ms > 0.0)
    std::fprintf(io.out, "    processor time: p50 %.3f, p99 %.3f, mean %.3f ms\n", r.processor_p50_ms, r.processor_p99_ms, r.processor_mean_ms);
  if (const Undisturbed& u = r.undisturbed; u.passes > 0)
    std::fprintf(io.out, "    undisturbed (each step's least time of %d passes): p50 %.3f, p99 %.3f, max %.3f ms\n", u.passes, u.p50_ms, u.p99_ms, u.max_ms);
  for (const auto& [name, ms] : r.stages) std::fprintf(io.out, "    %-40s %9.4f\n", name.c_str(), ms);
  for (const auto& [name, ms] : r.slow_stages) std::fprintf(io.out, "    in the slowest hundredth: %-24s %9.4f\n", name.c_str(), ms);
  std::fflush(io.out);
}

/// Two vessels whose cut edges face each other, as evidence/sewn_bench.h sews them.
bool two_stumps(const Model& model) {
  if (!model.vessel || !model.vessel->lumen) return false;
  const std::vector<int>& sectors = model.vessel->mesh.sectors;
  return sectors.size() == 2 && sectors[0] > 0 && sectors[1] > 0;
}

/// On stderr every ten seconds, for runs of minutes or a night.
class WildClock {
 public:
  WildClock(const std::string& task, const BenchOptions& o, double dt, const Streams& io) : task_(task), options_(o), dt_(dt), io_(io) {}
  void tell(const WildRun& run) {
    const auto now = std::chrono::steady_clock::now();
    if (now - last_ < std::chrono::seconds(10)) return;
    last_ = now;
    std::fprintf(io_.err, "filum: %s, seed %llu (%d to %d): %.0f of %.0f s of scene\n", task_.c_str(), static_cast<unsigned long long>(run.seed), options_.wild_first,
                 options_.wild_first + options_.wild - 1, dt_ * static_cast<double>(run.steps), options_.wild_seconds);
  }

 private:
  const std::string& task_;
  const BenchOptions& options_;
  double dt_;  // [s]
  const Streams& io_;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

/// Whether scenes survive hands that do anything, and how late their steps were.
nlohmann::ordered_json wild_json(const std::string& task, const BenchOptions& o, const Streams& io) {
  using Json = nlohmann::ordered_json;
  const Setup setup = load_setup(o.common.root, task);
  if (o.wild_sewn > 0 && !two_stumps(*setup.model)) throw InputError("bench", "--wild-sewn", "task " + task, "a task with two vessels end to end");
  const auto sewn = o.wild_sewn > 0 ? sewn_stumps(setup.model, o.wild_sewn) : std::pair(setup.model, State());
  World world(sewn.first);
  const State first = o.wild_sewn > 0 ? sewn.second : world.state();
  WildRun worst;
  std::uint64_t steps = 0;
  Json faults = Json::array();
  const double dt = setup.model->description.dt;
  WildClock clock(task, o, dt, io);
  for (int seed = o.wild_first; seed < o.wild_first + o.wild; ++seed) {
    const WildRun run = run_wild(world, first, static_cast<std::uint64_t>(seed), static_cast<int>(std::lround(o.wild_seconds / dt)), [&](const WildRun& r) { clock.tell(r); });
    if (!run.fault.empty()) faults.push_back({{"seed", seed}, {"step", run.steps}, {"fault", run.fault}});
    steps += run.steps;
    worst.fastest = std::max(worst.fastest, run.fastest);
    worst.deepest = std::max(worst.deepest, run.deepest);
    worst.slowest_ms = std::max(worst.slowest_ms, run.slowest_ms);
    worst.late += run.late;
    worst.trouble += run.trouble;
    worst.apart = std::max(worst.apart, run.apart);
    worst.buried = std::max(worst.buried, run.buried);
  }
  return {{"task", task}, {"first_seed", o.wild_first}, {"seeds", o.wild}, {"steps", steps}, {"scene_s", static_cast<double>(steps) * dt}, {"faults", faults}, {"fastest_m_per_s", worst.fastest},
          {"deepest_share", worst.deepest}, {"longest_step_ms", worst.slowest_ms}, {"late_steps", worst.late}, {"solver_trouble_events", worst.trouble}, {"apart_steps", worst.apart}, {"buried_steps", worst.buried}};
}

int run_wild_hands(const BenchOptions& o, const Streams& io) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  bool sound = true;
  for (const std::string& task : o.names.empty() ? kWildTasks : o.names) {
    list.push_back(wild_json(task, o, io));
    sound = sound && list.back()["faults"].empty();
    if (!o.common.json) std::fprintf(io.out, "%s\n", list.back().dump().c_str());
    std::fflush(io.out);
  }
  if (o.common.json) print_json(io.out, {{"machine", machine_text()}, {"wild", list}});
  return sound ? kDone : kFailed;
}

int run(const BenchOptions& o, const Streams& io) {
  if (o.wild > 0) return run_wild_hands(o, io);
  const auto names = o.names.empty() ? possible_benches(o.common.root, io) : o.names;
  if (!o.common.json) {
    std::fprintf(io.out, "%s\n%-18s %5s %8s %6s %6s %8s %8s %8s %9s %12s %8s\n", machine_text().c_str(), "bench",
                "nodes", "contacts", "dt ms", "steps", "p50 ms", "p99 ms", "max ms", "real time",
                "reference ms", "p50/ref");
  }
  const auto opener = [&](const std::string& task) { return driven_task(o.common.root, task); };
  const auto results = run_benches(names, opener, o.common.json ? BenchProgress() : [&io](const BenchResult& r) { print_line(r, io); });
  if (o.common.json) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const BenchResult& r : results) list.push_back(json_of(r));
    print_json(io.out, {{"machine", machine_text()}, {"benches", list}});
  }
  return kDone;
}

}  // namespace

void add_bench(CLI::App& app, Action& action) {
  auto o = std::make_shared<BenchOptions>();
  CLI::App* command = app.add_subcommand("bench", "Time the simulation's steps on this machine");
  command->add_option("name", o->names,
                      "Benches to run, by name or beginning of the name up to a hyphen (default: all)");
  command->add_option("--wild", o->wild, "Instead: so many seeds of violent random hands on the tasks named (default: one of every kind)")->check(CLI::Range(1, 1000000));
  command->add_option("--wild-first", o->wild_first, "The first of the seeds")->check(CLI::Range(1, 1000000000));
  command->add_option("--wild-seconds", o->wild_seconds, "Scene time of each seed")->check(between(0.01, 3600.0));
  command->add_option("--wild-sewn", o->wild_sewn, "So many stitches by construction that they find (tasks with two vessels end to end)")->check(CLI::Range(1, 8));
  add_common(*command, o->common);
  command->callback([o, &action] { action.run = [o](const Streams& io) { return run(*o, io); }; });
}

}  // namespace filum
