// GET /api/sessions... : what the store holds, in the words of messages.schema.json.

#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "cli/options.h"
#include "cli/session_files.h"
#include "cli/trainer.h"

namespace filum {
namespace {

using Json = nlohmann::ordered_json;

Json info_json(const StoreEntry& e, const std::string& title, const Conditions& made) {
  return {{"id", e.id},
          {"task", e.task},
          {"title", title},
          {"input", made.input},
          {"exam", made.exam},
          {"stiffness", made.stiffness},
          {"code", e.participant},
          {"started", e.started_utc},
          {"seconds", e.seconds},
          {"finished", e.finished},
          {"passed", e.scored ? Json(e.passed) : Json(nullptr)},
          {"total", e.scored ? Json(e.total) : Json(nullptr)}};
}

}  // namespace

/// From what the recording says of it; of one that cannot be read nothing is known. A recording that has ended is opened for it once.
Conditions Trainer::conditions_of(const std::string& session) {
  const auto known = conditions_.find(session);
  if (known != conditions_.end()) return known->second;
  try {
    const RecordingReader recording(store_->file_of(session));
    const Conditions made = read_conditions(recording);
    if (recording.finished()) conditions_[session] = made;
    return made;
  } catch (const InputError&) {
    return {};  // damaged: the store's check says so
  }
}

/// JSON of a stored session's result.
std::optional<std::string> Trainer::result_of(const std::string& session) {
  const auto file = recording_of(session);
  if (!file) return std::nullopt;
  try {
    const RecordingReader recording(*file);
    if (recording.score()) return recording.score()->json;
  } catch (const InputError&) {
    // running or damaged: the store's check names the damage
  }
  return std::nullopt;
}

std::optional<std::string> Trainer::post(std::string_view path, const std::string& body) {
  if (desk_)
    if (auto answer = desk_->post(path, body)) return answer;
  return lab_.post(path, body);
}

std::optional<Document> Trainer::document(std::string_view path) {
  if (desk_)
    if (auto found = desk_->document(path)) return found;
  return lab_.document(path);
}

std::optional<std::string> Trainer::api(std::string_view path) {
  if (desk_)
    if (auto answer = desk_->get(path)) return answer;
  constexpr std::string_view kSessions = "/api/sessions";
  if (!path.starts_with(kSessions)) return lab_.get(path);
  path.remove_prefix(kSessions.size());
  const std::lock_guard lock(store_mutex_);
  const auto title_of = [this](const std::string& task) {
    const auto title = titles_.find(task);
    return title == titles_.end() ? task : title->second;
  };
  if (path.empty()) {
    Json list = Json::array();
    if (store_) {
      for (const StoreEntry& entry : store_->list()) list.push_back(info_json(entry, title_of(entry.task), conditions_of(entry.id)));
    }
    return json_text({{"sessions", list}});
  }
  path.remove_prefix(1);
  const bool series = path.ends_with("/series");
  const std::string id(series ? path.substr(0, path.size() - std::string_view("/series").size()) : path);
  const auto entry = store_ ? store_->find(id) : std::nullopt;
  if (!entry) return std::nullopt;
  Json result = nullptr;
  try {
    const RecordingReader recording(store_->file_of(entry->id));
    const std::string message = recording.score() ? result_message(recording.score()->json, entry->id) : "";
    if (!message.empty()) result = Json::parse(message);
  } catch (const InputError&) {
    // A session that is running or damaged has no result to show; the store's check names the damage.
  }
  if (!series) return json_text({{"session", info_json(*entry, title_of(entry->task), conditions_of(entry->id))}, {"result", result}});
  if (result.is_null()) return json_text({{"series", Json::array()}, {"paths", Json::array()}});
  return json_text({{"series", result["series"]}, {"paths", result["paths"]}});
}

}  // namespace filum
