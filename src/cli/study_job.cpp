#include "cli/study_job.h"

#include <nlohmann/json.hpp>

#include "analysis/noise_floor.h"
#include "analysis/study_page.h"
#include "base/error.h"
#include "cli/options.h"

namespace filum {
namespace {

using Json = nlohmann::ordered_json;
constexpr std::size_t kMost = 1000;  // sessions

}  // namespace

StudyJob::~StudyJob() {
  cancel();
  if (worker_.joinable()) worker_.join();
}

void StudyJob::set(const State& state) {
  const std::lock_guard lock(guard_);
  now_ = state;
}

Json StudyJob::status() const {
  const std::lock_guard lock(guard_);
  Json left_out = Json::array(), tasks = Json::array();
  for (const LeftOut& one : now_.left_out) left_out.push_back({{"id", one.id}, {"why", one.why}});
  if (done_)
    for (const TaskStudy& t : done_->tasks) tasks.push_back(t.task);
  return {{"state", now_.state}, {"message", now_.message}, {"at", now_.at}, {"of", now_.of}, {"left_out", left_out}, {"tasks", tasks}};
}

void StudyJob::start(std::vector<Choice> sessions, std::vector<Choice> clamped) {
  if (sessions.empty() || sessions.size() > kMost) throw InputError("study", "sessions", std::to_string(sessions.size()), "1 to " + std::to_string(kMost) + " recordings");
  {
    const std::lock_guard lock(guard_);
    if (now_.state == "running") throw InputError("study", "sessions", "a study that runs", "to wait for it, or to cancel it");
    now_ = {"running", "", 0, sessions.size() + clamped.size(), {}};
    done_.reset();
  }
  if (worker_.joinable()) worker_.join();
  cancelled_ = false;
  worker_ = std::thread([this, sessions = std::move(sessions), clamped = std::move(clamped)] { work(sessions, clamped); });
}

void StudyJob::work(const std::vector<Choice>& sessions, const std::vector<Choice>& clamped) {
  State state{"running", "", 0, sessions.size() + clamped.size(), {}};
  std::vector<RecordedSession> still;
  std::vector<StudySession> studied;
  const auto each = [&](const std::vector<Choice>& choices, const auto& take) {
    for (const Choice& choice : choices) {
      if (cancelled_) return;
      try {
        RecordedSession session = load_(choice.file);
        session.file = choice.id;  // what people know it by
        take(std::move(session));
      } catch (const std::exception& error) {
        state.left_out.push_back({choice.id, error.what()});
      }
      ++state.at;
      set(state);
    }
  };
  each(clamped, [&](RecordedSession session) { still.push_back(std::move(session)); });
  each(sessions, [&](RecordedSession session) { studied.push_back(study_session(session, clamped_like(session, still))); });
  state.state = cancelled_ ? "cancelled" : studied.empty() ? "failed" : "done";
  if (state.state == "failed") state.message = "None of the sessions can be read.";
  Study study = study_of(studied, program_text());
  const std::lock_guard lock(guard_);
  if (state.state == "done") done_ = std::move(study);
  now_ = state;
}

std::optional<Document> StudyJob::file(const std::string& name) const {
  const std::lock_guard lock(guard_);
  if (!done_) return std::nullopt;
  if (name == "study.html") return Document{"text/html; charset=utf-8", study_page(*done_)};
  if (name == "study.json") return Document{"application/json", study_json(*done_).dump(2, ' ', false, Json::error_handler_t::replace)};
  if (name == "sessions.csv") return Document{"text/csv; charset=utf-8", sessions_csv(*done_)};
  if (name == "parts.csv") return Document{"text/csv; charset=utf-8", parts_csv(*done_)};
  if (!name.starts_with("plot-") || !name.ends_with(".svg")) return std::nullopt;
  std::string svg = study_plot(*done_, name.substr(5, name.size() - 9));
  if (svg.empty()) return std::nullopt;
  return Document{"image/svg+xml", std::move(svg)};
}

}  // namespace filum
