// filum reconcile: where simulation and measurement disagree, and which effect is missing.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <sstream>
#include <unistd.h>

#include "base/error.h"
#include "base/file_kind.h"
#include "base/out_folder.h"
#include "cli/options.h"
#include "ranks/ranks.h"
#include "reconcile/plugin.h"
#include "reconcile/report.h"

namespace filum {
namespace {

namespace fs = std::filesystem;

struct ReconcileOptions : CommonOptions {
  std::string dataset, out, all;
  int threads = 0;  // 0: two, but one for each process under mpirun
  bool again = false, repeatable = false;
};

void show_progress(const std::string& stage, double share, const Streams& io) {
  if (isatty(fileno(io.err)) == 0) return;
  const int filled = static_cast<int>(30 * share);
  std::fprintf(io.err, "\r[%-30s] %-14s", std::string(static_cast<std::size_t>(filled), '#').c_str(), stage.c_str());
  if (share >= 1.0) std::fputc('\n', io.err);
}

reconcile::Result solve(const std::string& folder, const std::string& out, const ReconcileOptions& o, int threads, bool progress, std::string& name, const Streams& io) {
  const reconcile::Dataset d = reconcile::load_dataset(folder, o.root);
  reconcile::Options options;
  options.threads = threads;
  if (progress) options.progress = [&io](const std::string& stage, double share) { show_progress(stage, share, io); };
  reconcile::Result r = reconcile::reconcile(d, options);
  if (o.repeatable) r.seconds = std::numeric_limits<double>::quiet_NaN();
  if (progress) show_progress("done", 1.0, io);
  reconcile::write_report(d, r, {out, program_text()});
  name = d.name;
  if (progress)
    for (const std::string& notice : d.notices) std::fprintf(io.err, "%s\n", notice.c_str());
  if (progress)
    for (const reconcile::HardwareCheck& h : r.decide.units) std::fprintf(io.err, "%s: %s\n", h.where.c_str(), h.found.c_str());
  if (progress && o.json) print_json(io.out, reconcile::report_json(d, r));
  return r;
}

int run_one(const ReconcileOptions& o, const Streams& io) {
  std::string name;
  const reconcile::Result r = solve(o.dataset, o.out, o, o.threads > 0 ? o.threads : 2, true, name, io);
  if (o.json) return kDone;
  std::fprintf(io.out, "%s: %s%s", name.c_str(), r.decide.verdict.c_str(), r.decide.partial ? " (partial)" : "");
  if (r.decide.verdict == "effect")
    for (const auto& e : r.decide.effects) std::fprintf(io.out, " %s", reconcile::info(e.effect).name.c_str());
  std::fprintf(io.out, "\n%s\ngap: fit %.3g -> %.3g, ", r.decide.sentence.c_str(), r.decide.gap.before, r.decide.gap.after);
  if (std::isfinite(r.challenge.gap.before)) std::fprintf(io.out, "held out %.3g -> %.3g (noise = 1)\n", r.challenge.gap.before, r.challenge.gap.after);
  else std::fprintf(io.out, "none held out: %s (noise = 1)\n", r.challenge.how.c_str());
  std::fprintf(io.out, "%s/report.html, %.1f s\n", o.out.c_str(), r.seconds);
  return kDone;
}

/// One of several processes of one start: its number, how many they are, and whether who started them also started MPI's own exchange.
struct Share {
  std::size_t rank = 0, size = 1;
  bool mpi = false;
};

/// As mpirun or srun say in the environment; 0 of 1 without them.
Share share_of_start() {
  const bool pmix = std::getenv("PMIX_NAMESPACE") != nullptr;
  struct Names {
    const char *rank, *size;
    bool mpi;
  };
  for (const Names& names : {Names{"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE", true}, Names{"PMI_RANK", "PMI_SIZE", true}, Names{"SLURM_PROCID", "SLURM_NTASKS", pmix}}) {
    const char *r = std::getenv(names.rank), *n = std::getenv(names.size);
    if (r != nullptr && n != nullptr && std::atoi(n) > 1) return {static_cast<std::size_t>(std::atoi(r)), static_cast<std::size_t>(std::atoi(n)), names.mpi};
  }
  return {};
}

/// MPI where several processes were started with it and the module is there; else nothing, and the environment's numbers must do. It is not
/// asked where nobody started it: processes that each start a world of their own at the same moment may abort (OpenMPI's folder in /tmp).
std::unique_ptr<Ranks> start_ranks(const Share& share, const Streams& io) {
  if (share.size == 1) return nullptr;
  if (!share.mpi) {
    std::fprintf(io.err, "without MPI, which was not started: each of %zu processes takes its share by number\n", share.size);
    return nullptr;
  }
  std::string why;
  const auto start = reinterpret_cast<StartRanks>(reconcile::module_function("filum_ranks", kStartRanks, &why));
  if (start == nullptr && !why.empty()) std::fprintf(io.err, "without MPI: %s\n", why.c_str());
  std::unique_ptr<Ranks> ranks(start == nullptr ? nullptr : start());
  if (ranks != nullptr && static_cast<std::size_t>(ranks->size()) != share.size) {  // another MPI than the module's: each sees itself alone
    std::fprintf(io.err, "without MPI: it sees %d of %zu processes; each takes its share by number\n", ranks->size(), share.size);
    ranks.reset();
  }
  return ranks;
}

/// A report that was cut, as by a copy that did not end, is none.
bool has_report(const ReconcileOptions& o, const std::string& name) {
  std::ifstream in(fs::path(o.out) / name / "report.json", std::ios::binary);
  return in && parsed_json({std::istreambuf_iterator<char>(in), {}}).is_object();
}

/// Datasets of the folder that have no report yet, one name a line.
std::string unfinished(const ReconcileOptions& o) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(o.all))
    if (is_file(entry.path() / "experiment.yaml")) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  std::string list;
  for (const std::string& name : names)
    if (o.again || !has_report(o, name)) list += name + "\n";
  return list;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> out;
  std::istringstream s(text);
  for (std::string line; std::getline(s, line);) out.push_back(line);
  return out;
}

/// Every dataset below a folder, each on one thread; those that have a report already are left alone. Under MPI the processes take them
/// from one list as they get free; with the environment's numbers alone every process takes each n-th of all.
int run_all(const ReconcileOptions& o, const Streams& io) {
  if (!is_folder(o.all)) throw InputError("--all", "folder", o.all, "a folder of datasets");
  const Share share = share_of_start();
  const std::unique_ptr<Ranks> ranks = start_ranks(share, io);
  ReconcileOptions every = o;
  every.again = true;
  const bool by_number = ranks == nullptr && share.size > 1;
  // without a common list processes that start late would see fewer names: then all are counted, and finished ones passed over
  const std::vector<std::string> names = lines_of(ranks != nullptr ? ranks->from_first(unfinished(o)) : unfinished(by_number ? every : o));
  std::atomic<long> own = static_cast<long>(share.rank);
  const auto next = [&, stride = static_cast<long>(share.size)] { return ranks != nullptr ? ranks->next() : own.fetch_add(stride); };
  std::mutex guard;
  std::atomic<long> bad = 0, done = 0;
  const int threads = o.threads > 0 ? o.threads : share.size > 1 ? 1 : 2;
  reconcile::parallel(threads, static_cast<std::size_t>(threads), [&](std::size_t) {
    for (long i = next(); i < static_cast<long>(names.size()); i = next()) {
      const std::string& folder = names[static_cast<std::size_t>(i)];
      if (by_number && !o.again && has_report(o, folder)) continue;
      std::string name, line;
      try {
        const auto r = solve((fs::path(o.all) / folder).string(), (fs::path(o.out) / folder).string(), o, 1, false, name, io);
        line = name + ": " + r.decide.verdict;
        for (const auto& e : r.decide.effects) line += " " + reconcile::info(e.effect).name;
      } catch (const std::exception& error) {
        ++bad;
        line = folder + ": refused: " + error.what();
      }
      const std::lock_guard lock(guard);
      std::fprintf(io.err, "%ld/%zu %s\n", ++done, names.size(), line.c_str());
    }
  });
  const long refused = ranks != nullptr ? ranks->sum(bad) : bad.load();
  return refused > 0 ? kBadInput : kDone;
}

}  // namespace

void add_reconcile(CLI::App& app, Action& action) {
  auto o = std::make_shared<ReconcileOptions>();
  CLI::App* command = app.add_subcommand("reconcile", "Find where simulation and measurement disagree and name the missing effect");
  add_common(*command, *o);
  command->add_option("dataset", o->dataset, "Folder with experiment.yaml (filum-experiment/1)");
  command->add_option("--all", o->all, "Every dataset in this folder; finished ones are left alone");
  command->add_option("--out", o->out, "Folder for report.json, report.html and model.yaml")->required();
  command->add_option("--threads", o->threads, "Threads; 2, or 1 for each process under mpirun")->check(CLI::Range(1, 256));
  command->add_flag("--again", o->again, "With --all: also those that have a report");
  command->add_flag("--repeatable", o->repeatable, "Leave the time it took out of the report, so that equal data give equal files");
  command->callback([o, &action] {
    action.run = [o](const Streams& io) {
      if (o->again && o->all.empty()) throw InputError("--again", "DATASET", o->dataset.empty() ? "nothing" : o->dataset, "--all FOLDER beside it: one dataset is always solved");
      if (o->dataset.empty() == o->all.empty()) throw InputError("reconcile", "DATASET", o->dataset.empty() ? "nothing" : "a folder and --all", "one folder, or --all FOLDER");
      require_out_folder("--out", o->out);
      return o->all.empty() ? run_one(*o, io) : run_all(*o, io);
    };
  });
}

}  // namespace filum
