#include "cli/camera_session.h"

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "cli/requests.h"

namespace filum {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

std::vector<std::string> arguments(const CameraPlan& p) {
  return {p.program, "guide", "--source", p.source, "--folder", p.folder, "--square", std::to_string(p.square), "--name", p.name};
}

}  // namespace

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
  Json json = parsed_json(said_);
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
