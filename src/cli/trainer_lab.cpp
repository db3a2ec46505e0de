#include "cli/trainer_lab.h"

#include <nlohmann/json.hpp>

#include "analysis/report_page.h"
#include "base/error.h"
#include "cli/options.h"
#include "cli/session_files.h"

namespace filum {
namespace {

using Json = nlohmann::ordered_json;
constexpr std::size_t kKept = 8;  // analyses

/// Takes a prefix off; false if it is not there.
bool take(std::string_view& path, std::string_view prefix) {
  if (!path.starts_with(prefix)) return false;
  path.remove_prefix(prefix.size());
  return true;
}

/// What was asked for, or why it is refused; nothing where there is no such thing (null).
template <class Ask>
std::optional<std::string> answer(const Ask& ask) {
  try {
    const Json said = ask();
    if (said.is_null()) return std::nullopt;
    return json_text(said);
  } catch (const InputError& error) {
    return json_text({{"refused", error.field + ": found " + error.value + ", expected " + error.expected}});
  } catch (const std::exception& error) {
    return json_text({{"refused", error.what()}});
  }
}

std::string page_of(const std::string& file, const std::string& clamped) {
  AnalysisInput input;
  input.sessions.push_back(open_session(file));
  if (!clamped.empty()) input.clamped = open_session(clamped);
  return report_page(analyse(input, program_text()));
}

}  // namespace

TrainerLab::TrainerLab(LabOptions options, std::function<std::optional<std::string>(const std::string&)> recording_of)
    : options_(std::move(options)), recording_of_(std::move(recording_of)), upload_(options_.datasets), reconcile_(options_.datasets, options_.folder + "/reports", options_.root), study_(open_session), chosen_(options_.calibration) {}

TrainerLab::~TrainerLab() {
  if (analyst_.joinable()) analyst_.join();
}

std::string TrainerLab::calibration() const {
  const std::lock_guard lock(guard_);
  return chosen_;
}

bool TrainerLab::calibrating() const {
  const std::lock_guard lock(guard_);
  return calibration_ != nullptr;
}

Json TrainerLab::calibration_status() const {
  const std::lock_guard lock(guard_);
  return {{"port", options_.serial_port}, {"in_use", chosen_}, {"run", calibration_ ? calibration_->status() : Json(nullptr)}};
}

std::optional<std::string> TrainerLab::get(std::string_view path) {
  if (path == "/api/reconcile") return json_text(reconcile_.status());
  if (path == "/api/calibration") return json_text(calibration_status());
  if (path == "/api/study") return json_text(study_.status());
  if (path == "/api/camera") return json_text(camera_status());
  if (!take(path, "/api/analysis/")) return std::nullopt;
  const std::size_t slash = path.find('/');
  return analysis(std::string(path.substr(0, slash)), slash == path.npos ? "" : std::string(path.substr(slash + 1)));
}

std::optional<std::string> TrainerLab::post(std::string_view path, const std::string& body) {
  return answer([&] { return change(path, body); });
}

std::optional<std::string> TrainerLab::put(std::string_view path, const std::string& body) {
  return answer([&] { return take(path, "/api/upload/") ? upload_.part(path, body) : Json(nullptr); });
}

Json TrainerLab::change_upload(std::string_view what, const std::string& body) {
  if (what == "begin") return upload_.begin(body);
  if (what == "finish") return upload_.finish(body);
  if (what == "cancel") return upload_.cancel(body);
  return nullptr;
}

Json TrainerLab::camera_status() const {
  const std::lock_guard lock(guard_);
  return {{"there", !options_.camera_program.empty()}, {"fixed", options_.camera}, {"run", camera_ ? camera_->status() : Json(nullptr)}};
}

/// A session is ended outside the lock: its program may take a moment to let the camera go.
Json TrainerLab::change_camera(std::string_view what, const std::string& body) {
  std::unique_ptr<CameraSession> old, fresh;
  if (what == "start") {
    auto plan = camera_plan(body, options_.camera_program, options_.folder + "/calibrations", options_.camera);
    {
      const std::lock_guard lock(guard_);
      old = std::move(camera_);
    }
    old.reset();  // lets the camera go before it is opened again
    fresh = std::make_unique<CameraSession>(std::move(plan));
  }
  {
    const std::lock_guard lock(guard_);
    if (fresh) camera_ = std::move(fresh);
    else if (!camera_) throw InputError("camera", "run", "none", "a calibration that was started");
    else if (what == "undo" || what == "calibrate") camera_->tell(std::string(what));
    else if (what == "stop") old = std::move(camera_);
    else return nullptr;
  }
  old.reset();
  return camera_status();
}

Json TrainerLab::change_study(std::string_view what, const std::string& body) {
  const auto choices = [&](const char* name) {
    std::vector<StudyJob::Choice> list;
    for (const std::string& id : requested_names(body, name)) {
      const auto file = recording_of_(id);
      if (!file) throw InputError("study", name, id, "the identifier of a stored session");
      list.push_back({id, *file});
    }
    return list;
  };
  if (what == "start") study_.start(choices("sessions"), choices("clamped"));
  else if (what == "cancel") study_.cancel();
  else return nullptr;
  return study_.status();
}

Json TrainerLab::change(std::string_view path, const std::string& body) {
  if (take(path, "/api/camera/")) return change_camera(path, body);
  if (take(path, "/api/study/")) return change_study(path, body);
  if (take(path, "/api/upload/")) return change_upload(path, body);
  if (path == "/api/reconcile/start") reconcile_.start(requested_text(body, "dataset"));
  else if (path == "/api/reconcile/cancel") reconcile_.cancel();
  else if (!path.starts_with("/api/calibration/")) return nullptr;
  if (path.starts_with("/api/reconcile/")) return reconcile_.status();
  take(path, "/api/calibration/");
  if (path == "start") {
    if (options_.serial_port.empty()) throw InputError("calibration", "port", "none", "a trainer started with --serial PATH");
    if (port_in_use_) throw InputError("calibration", "port", "a task that uses the forceps", "to end the task first");
    auto plan = calibration_plan(body, options_.serial_port, options_.root, options_.folder + "/calibrations");
    const std::lock_guard lock(guard_);
    calibration_.reset();  // closes the port before it is opened again
    calibration_ = std::make_unique<CalibrationSession>(std::move(plan));
  } else {
    const std::lock_guard lock(guard_);
    if (!calibration_) throw InputError("calibration", "run", "none", "a calibration that was started");
    if (path == "read") calibration_->read();
    else if (path == "undo") calibration_->undo();
    else if (path == "stop") calibration_.reset();
    else if (path == "use") {
      if (calibration_->file().empty()) throw InputError("calibration", "file", "none", "a calibration that was accepted");
      chosen_ = calibration_->file();
      calibration_.reset();
    } else return nullptr;
  }
  return calibration_status();
}

std::optional<Document> TrainerLab::document(std::string_view path) {
  if (take(path, "/documents/analysis/")) {
    const std::lock_guard lock(guard_);
    const auto at = analyses_.find(std::string(path));
    if (at == analyses_.end() || at->second.state != "ready") return std::nullopt;
    return Document{"text/html; charset=utf-8", at->second.text};
  }
  if (take(path, "/documents/study/")) return study_.file(std::string(path));
  if (path == "/documents/camera/preview.jpg") {
    const std::lock_guard lock(guard_);
    auto picture = camera_ ? camera_->preview() : std::nullopt;
    if (!picture) return std::nullopt;
    return Document{"image/jpeg", std::move(*picture)};
  }
  if (!take(path, "/documents/reconcile/")) return std::nullopt;
  const std::size_t slash = path.find('/');
  if (slash == path.npos) return std::nullopt;
  const std::string name(path.substr(slash + 1));
  auto text = reconcile_.file(std::string(path.substr(0, slash)), name);
  if (!text) return std::nullopt;
  return Document{name.ends_with(".html") ? "text/html; charset=utf-8" : "text/plain; charset=utf-8", std::move(*text)};
}

std::optional<std::string> TrainerLab::analysis(const std::string& session, const std::string& clamped) {
  const auto file = recording_of_(session);
  const auto floor = clamped.empty() ? std::optional<std::string>("") : recording_of_(clamped);
  if (!file || !floor) return std::nullopt;
  const std::string key = clamped.empty() ? session : session + "/" + clamped;
  const std::lock_guard lock(guard_);
  if (const auto at = analyses_.find(key); at != analyses_.end())
    return json_text({{"state", at->second.state}, {"document", at->second.state == "ready" ? "/documents/analysis/" + key : ""}, {"message", at->second.state == "failed" ? at->second.text : ""}});
  if (!analysing_) {
    analysing_ = true;
    if (analyst_.joinable()) analyst_.join();
    if (analyses_.size() >= kKept) analyses_.clear();
    analyses_[key] = {};
    analyst_ = std::thread([this, key, file = *file, floor = *floor] { analyse_in_background(key, file, floor); });
  }
  return json_text({{"state", "working"}, {"document", ""}, {"message", ""}});
}

void TrainerLab::analyse_in_background(const std::string& key, const std::string& file, const std::string& clamped) {
  Analysis done;
  try {
    done = {"ready", page_of(file, clamped)};
  } catch (const std::exception& error) {
    done = {"failed", error.what()};
  }
  const std::lock_guard lock(guard_);
  analyses_[key] = std::move(done);
  analysing_ = false;
}

}  // namespace filum
