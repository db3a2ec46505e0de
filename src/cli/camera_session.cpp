#include "cli/camera_session.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/error.h"

namespace filum {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

[[noreturn]] void refuse(const Json& wish, const char* key, const char* expected) {
  throw InputError("camera", key, wish[key].dump(-1, ' ', false, Json::error_handler_t::replace).substr(0, 80), expected);
}

std::vector<std::string> arguments(const CameraPlan& p) {
  return {p.program, "guide", "--source", p.source, "--folder", p.folder, "--square", std::to_string(p.square), "--name", p.name};
}

}  // namespace

CameraPlan camera_plan(const std::string& text, const std::string& program, const std::string& folder, const std::string& fixed_source) {
  if (program.empty()) throw InputError("camera", "program", "none", "filum_camera beside this program (built where OpenCV is)");
  const Json wish = Json::parse(text, nullptr, false);
  if (!wish.is_object()) throw InputError("camera", "body", text.substr(0, 80), "a JSON object");
  CameraPlan plan;
  plan.program = program;
  plan.folder = folder;
  if (wish.contains("source")) {
    if (!wish["source"].is_number_integer() || wish["source"] < 0 || wish["source"] > 99) refuse(wish, "source", "number of a camera, 0 to 99");
    plan.source = std::to_string(wish["source"].get<int>());
  }
  if (!fixed_source.empty()) plan.source = fixed_source;
  if (wish.contains("square")) {
    if (!wish["square"].is_number() || !(wish["square"] >= 1.0 && wish["square"] <= 200.0)) refuse(wish, "square", "1 to 200 mm");
    plan.square = wish["square"].get<double>();
  }
  if (wish.contains("name")) {
    if (!wish["name"].is_string() || wish["name"].get<std::string>().size() > 40) refuse(wish, "name", "up to 40 letters");
    plan.name = wish["name"].get<std::string>();
    const auto allowed = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_' || c == '.' || c == ' '; };
    if (plan.name.empty() || plan.name[0] == '-' || !std::all_of(plan.name.begin(), plan.name.end(), allowed)) refuse(wish, "name", "letters, digits, dots, blanks and dashes");
  }
  return plan;
}

std::string camera_program() {
  std::error_code error;
  const fs::path beside = fs::read_symlink("/proc/self/exe", error).parent_path() / "filum_camera";
  return !error && fs::is_regular_file(beside, error) ? beside.string() : std::string();
}

CameraSession::CameraSession(CameraPlan plan) : plan_(std::move(plan)), child_(arguments(plan_)) {
  std::error_code ignored;
  fs::remove(plan_.folder + "/preview.jpg", ignored);  // of another time
  thread_ = std::thread([this] { work(); });
}

CameraSession::~CameraSession() {
  quit_ = true;
  thread_.join();
}

void CameraSession::tell(const std::string& command) {
  const std::lock_guard lock(guard_);
  if (commands_.size() < 16) commands_.push_back(command);
}

void CameraSession::work() {
  std::string line;
  while (!quit_) {
    std::vector<std::string> commands;
    {
      const std::lock_guard lock(guard_);
      commands.swap(commands_);
    }
    for (const std::string& command : commands) child_.send(command);
    const auto read = child_.receive(line, 50);
    const std::lock_guard lock(guard_);
    if (read == ChildProcess::Read::line) said_ = line;
    if (read == ChildProcess::Read::ended) {
      failed_ = child_.errors().empty() ? "the camera's program has ended" : child_.errors();
      return;
    }
  }
}

Json CameraSession::status() const {
  const std::lock_guard lock(guard_);
  Json json = Json::parse(said_, nullptr, false);
  if (!json.is_object()) json = {{"state", "starting"}};
  if (!failed_.empty()) {
    json["state"] = "failed";
    json["trouble"] = failed_;
  }
  json["source"] = plan_.source;
  json["square"] = plan_.square;
  return json;
}

std::optional<std::string> CameraSession::preview() const {
  std::ifstream file(plan_.folder + "/preview.jpg", std::ios::binary);
  if (!file) return std::nullopt;
  return std::string(std::istreambuf_iterator<char>(file), {});
}

}  // namespace filum
