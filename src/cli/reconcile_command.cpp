// filum reconcile: where simulation and measurement disagree, and which effect is missing.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "base/error.h"
#include "cli/options.h"
#include "reconcile/report.h"
#include "reconcile/search.h"

namespace filum {
namespace {

namespace fs = std::filesystem;

struct ReconcileOptions : CommonOptions {
  std::string dataset, out, all;
  int threads = 2;
  bool again = false;
};

void show_progress(const std::string& stage, double share) {
  if (isatty(STDERR_FILENO) == 0) return;
  const int filled = static_cast<int>(30 * share);
  std::fprintf(stderr, "\r[%-30s] %-14s", std::string(static_cast<std::size_t>(filled), '#').c_str(), stage.c_str());
  if (share >= 1.0) std::fputc('\n', stderr);
}

reconcile::Result solve(const std::string& folder, const std::string& out, const ReconcileOptions& o, int threads, bool progress, std::string& name) {
  const reconcile::Dataset d = reconcile::load_dataset(folder, o.root);
  reconcile::Options options;
  options.threads = threads;
  if (progress) options.progress = show_progress;
  reconcile::Result r = reconcile::reconcile(d, options);
  if (progress) show_progress("done", 1.0);
  reconcile::write_report(d, r, out, program_text());
  name = d.name;
  if (progress && o.json) print_json(reconcile::report_json(d, r));
  return r;
}

int run_one(const ReconcileOptions& o) {
  std::string name;
  const reconcile::Result r = solve(o.dataset, o.out, o, o.threads, true, name);
  if (o.json) return kDone;
  std::printf("%s: %s%s", name.c_str(), r.verdict.c_str(), r.partial ? " (partial)" : "");
  if (r.verdict == "effect")
    for (const auto& e : r.effects) std::printf(" %s", reconcile::info(e.effect).name.c_str());
  std::printf("\n%s\ngap: fit %.3g -> %.3g, held out %.3g -> %.3g (noise = 1)\n%s/report.html, %.1f s\n", r.sentence.c_str(), r.fit.before, r.fit.after, r.held_out.before, r.held_out.after,
              o.out.c_str(), r.seconds);
  return kDone;
}

/// Number of this process and of all, as mpirun or srun say in the environment; 0 of 1 without them.
std::pair<std::size_t, std::size_t> rank_and_size() {
  for (const auto& [rank, size] : {std::pair{"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"}, std::pair{"PMI_RANK", "PMI_SIZE"}, std::pair{"SLURM_PROCID", "SLURM_NTASKS"}}) {
    const char *r = std::getenv(rank), *n = std::getenv(size);
    if (r != nullptr && n != nullptr && std::atoi(n) > 1) return {static_cast<std::size_t>(std::atoi(r)), static_cast<std::size_t>(std::atoi(n))};
  }
  return {0, 1};
}

/// Every dataset below a folder, each on one thread; those that have a report already are left alone.
int run_all(const ReconcileOptions& o) {
  if (!fs::is_directory(o.all)) throw InputError("--all", "folder", o.all, "a folder of datasets");
  std::vector<fs::path> folders;
  for (const auto& entry : fs::directory_iterator(o.all))
    if (fs::is_regular_file(entry.path() / "experiment.yaml")) folders.push_back(entry.path());
  std::sort(folders.begin(), folders.end());
  const auto [rank, ranks] = rank_and_size();
  std::vector<fs::path> mine;
  for (std::size_t i = 0; i < folders.size(); ++i)
    if (i % ranks == rank && (o.again || !fs::exists(fs::path(o.out) / folders[i].filename() / "report.json"))) mine.push_back(folders[i]);
  std::mutex guard;
  std::atomic<int> bad = 0, done = 0;
  reconcile::parallel(o.threads, mine.size(), [&](std::size_t i) {
    std::string name, line;
    try {
      const auto r = solve(mine[i].string(), (fs::path(o.out) / mine[i].filename()).string(), o, 1, false, name);
      line = name + ": " + r.verdict;
      for (const auto& e : r.effects) line += " " + reconcile::info(e.effect).name;
    } catch (const std::exception& error) {
      ++bad;
      line = mine[i].filename().string() + ": refused: " + error.what();
    }
    const std::lock_guard lock(guard);
    std::fprintf(stderr, "%d/%zu %s\n", ++done, mine.size(), line.c_str());
  });
  return bad > 0 ? kBadInput : kDone;
}

}  // namespace

void add_reconcile(CLI::App& app, Action& action) {
  auto o = std::make_shared<ReconcileOptions>();
  CLI::App* command = app.add_subcommand("reconcile", "Find where simulation and measurement disagree and name the missing effect");
  add_common(*command, *o);
  command->add_option("dataset", o->dataset, "Folder with experiment.yaml (filum-experiment/1)");
  command->add_option("--all", o->all, "Every dataset in this folder; finished ones are left alone");
  command->add_option("--out", o->out, "Folder for report.json, report.html and model.yaml")->required();
  command->add_option("--threads", o->threads, "Threads")->capture_default_str()->check(CLI::Range(1, 256));
  command->add_flag("--again", o->again, "With --all: also those that have a report");
  command->callback([o, &action] {
    action.run = [o] {
      if (o->dataset.empty() == o->all.empty()) throw InputError("reconcile", "DATASET", o->dataset.empty() ? "nothing" : "a folder and --all", "one folder, or --all FOLDER");
      return o->all.empty() ? run_one(*o) : run_all(*o);
    };
  });
}

}  // namespace filum
