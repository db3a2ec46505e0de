#include "cli/reconcile_job.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <vector>

#include "base/error.h"
#include "cli/options.h"
#include "reconcile/report.h"

namespace filum {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::vector<std::string> datasets_in(const std::string& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error))
    if (fs::is_regular_file(entry.path() / "experiment.yaml", error)) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

std::string whole(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// What a list shows of a report; null where there is none.
Json summary_of(const fs::path& folder) {
  const Json report = parsed_json(whole(folder / "report.json"));
  if (!report.is_object() || !report.contains("verdict")) return nullptr;
  Json effects = Json::array();
  for (const Json& e : report["effects"]) effects.push_back(e["name"]);
  return {{"verdict", report["verdict"]}, {"effects", effects}, {"partial", report["partial"]}, {"sentence", report.value("sentence", "")},
          {"model", fs::exists(folder / "model.yaml")}};
}

}  // namespace

ReconcileJob::~ReconcileJob() {
  cancel();
  if (worker_.joinable()) worker_.join();
}

void ReconcileJob::set(const State& state) {
  const std::lock_guard lock(guard_);
  now_ = state;
}

Json ReconcileJob::status() {
  Json list = Json::array();
  for (const std::string& name : datasets_in(datasets_)) list.push_back({{"name", name}, {"report", summary_of(fs::path(reports_) / name)}});
  const std::lock_guard lock(guard_);
  return {{"folder", datasets_},
          {"datasets", list},
          {"job", {{"state", now_.state}, {"dataset", now_.dataset}, {"stage", now_.stage}, {"share", now_.share}, {"message", now_.message}}}};
}

void ReconcileJob::start(const std::string& dataset) {
  const auto names = datasets_in(datasets_);
  if (std::find(names.begin(), names.end(), dataset) == names.end()) throw InputError("reconcile", "dataset", dataset, "a folder in " + datasets_);
  {
    const std::lock_guard lock(guard_);
    if (now_.state == "running") throw InputError("reconcile", "dataset", dataset, "to wait for " + now_.dataset + ", or to cancel it");
    now_ = {"running", dataset, "reading", "", 0.0};
  }
  if (worker_.joinable()) worker_.join();
  cancelled_ = false;
  worker_ = std::thread([this, dataset] { solve(dataset); });
}

void ReconcileJob::solve(std::string dataset) {
  try {
    const reconcile::Dataset d = reconcile::load_dataset((fs::path(datasets_) / dataset).string(), root_);
    reconcile::Options options;
    options.threads = 1;  // the other core is the trainer's
    options.progress = [&](const std::string& stage, double share) { set({"running", dataset, stage, "", share}); };
    options.cancelled = [this] { return cancelled_.load(); };
    const reconcile::Result r = reconcile::reconcile(d, options);
    reconcile::write_report(d, r, {(fs::path(reports_) / dataset).string(), program_text()});
    set({"done", dataset, "done", r.decide.sentence, 1.0});
  } catch (const reconcile::Cancelled&) {
    set({"cancelled", dataset, "", "Cancelled; nothing was written.", 0.0});
  } catch (const std::exception& error) {
    set({"failed", dataset, "", error.what(), 0.0});
  }
}

std::optional<std::string> ReconcileJob::file(const std::string& dataset, const std::string& name) const {
  const auto names = datasets_in(datasets_);
  if (std::find(names.begin(), names.end(), dataset) == names.end() || (name != "report.html" && name != "model.yaml")) return std::nullopt;
  const fs::path path = fs::path(reports_) / dataset / name;
  if (!fs::exists(path)) return std::nullopt;
  return whole(path);
}

}  // namespace filum
