#include "cli/dataset_upload.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>

#include "base/error.h"
#include "cli/requests.h"

namespace filum {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;
constexpr const char* kHalfSent = ".upload-";

/// Names of folders and files that mean the same everywhere, and nothing to a shell or a path.
const std::string& plain(const Json& object, const char* key) {
  const auto allowed = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_' || c == '.'; };
  if (!object.is_object() || !object.contains(key) || !object[key].is_string()) throw InputError("upload", key, json_shown_at(object, key), "a name");
  const auto& name = object[key].get_ref<const std::string&>();
  if (name.empty() || name.size() > 64 || name[0] == '.' || !std::all_of(name.begin(), name.end(), allowed))
    throw InputError("upload", key, json_shown(object[key]), "1 to 64 letters, digits, dots, - and _, no dot first");
  return name;
}

std::size_t size_of(const Json& file) {
  if (!file.contains("bytes") || !file["bytes"].is_number_unsigned()) throw InputError("upload", "bytes", json_shown(file), "the file's size");
  return file["bytes"].get<std::size_t>();
}

unsigned long number_in(const std::string& body) {
  const Json json = parsed_json(body);
  if (!json.is_object() || !json.contains("upload") || !json["upload"].is_number_unsigned()) throw InputError("upload", "upload", json_shown_at(json, "upload"), "the number of an upload");
  return json["upload"].get<unsigned long>();
}

/// "3/0/1048576"
std::array<std::size_t, 3> numbers_in(std::string_view where) {
  std::array<std::size_t, 3> numbers{};
  const char *at = where.data(), *end = at + where.size();
  for (std::size_t k = 0; k < 3; ++k) {
    const auto read = std::from_chars(at, end, numbers[k]);
    const bool last = k == 2;
    if (read.ec != std::errc{} || (last ? read.ptr != end : read.ptr == end || *read.ptr != '/')) throw InputError("upload", "part", std::string(where.substr(0, 80)), "UPLOAD/FILE/OFFSET");
    at = read.ptr + (last ? 0 : 1);
  }
  return numbers;
}

/// Adds to the end of a file; errno, or 0.
int append(const std::string& file, const std::string& bytes) {
  const int at = ::open(file.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  if (at < 0) return errno;
  int error = 0;
  for (std::size_t done = 0; done < bytes.size() && error == 0;) {
    const ssize_t put = ::write(at, bytes.data() + done, bytes.size() - done);
    if (put > 0) done += static_cast<std::size_t>(put);
    else if (errno != EINTR) error = put == 0 ? ENOSPC : errno;
  }
  if (::close(at) != 0 && error == 0) error = errno;
  return error;
}

/// Is it being sent to another trainer, which still runs? `name`: kHalfSent, its process, a dash.
bool is_of_another(const std::string& name) {
  const int process = std::atoi(name.c_str() + std::string_view(kHalfSent).size());
  return process > 0 && process != ::getpid() && (::kill(process, 0) == 0 || errno == EPERM);
}

}  // namespace

DatasetUpload::DatasetUpload(std::string datasets, std::chrono::milliseconds patience) : datasets_(std::move(datasets)), patience_(patience) {
  std::vector<fs::path> left;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(datasets_, ignored))
    if (const std::string name = entry.path().filename().string(); name.starts_with(kHalfSent) && !is_of_another(name)) left.push_back(entry.path());
  for (const fs::path& folder : left) fs::remove_all(folder, ignored);
}

DatasetUpload::~DatasetUpload() { drop(); }

std::string DatasetUpload::folder() const { return datasets_ + "/" + kHalfSent + std::to_string(::getpid()) + "-" + std::to_string(number_); }

void DatasetUpload::drop() {
  if (dataset_.empty()) return;
  std::error_code ignored;
  fs::remove_all(folder(), ignored);
  dataset_.clear();
}

Json DatasetUpload::status() const {
  std::size_t received = 0, all = 0;
  for (const File& f : files_) received += f.received, all += f.bytes;
  return {{"upload", number_}, {"bytes", received}, {"of", all}};
}

Json DatasetUpload::begin(const std::string& body) {
  const Json json = parsed_json(body);
  const std::string dataset = plain(json, "dataset");
  if (!json.contains("files") || !json["files"].is_array() || json["files"].empty() || json["files"].size() > kUploadFiles)
    throw InputError("upload", "files", "none, or too many", "1 to " + std::to_string(kUploadFiles) + " files");
  std::vector<File> files;
  std::set<std::string> names;
  std::size_t all = 0;
  for (const Json& file : json["files"]) {
    files.push_back({plain(file, "name"), size_of(file), 0});
    if (!names.insert(files.back().name).second) throw InputError("upload", "name", files.back().name + " twice", "every file once");
    all = std::min(all, kUploadBytes) + std::min(files.back().bytes, kUploadBytes + 1);
  }
  if (names.count("experiment.yaml") == 0) throw InputError("upload", "files", "no experiment.yaml", "a folder with experiment.yaml");
  if (all > kUploadBytes) throw InputError("upload", "bytes", "more", "at most " + std::to_string(kUploadBytes >> 20) + " MiB in all");
  if (fs::exists(fs::path(datasets_) / dataset)) throw InputError("upload", "dataset", dataset + ", which is there already", "another name, or that folder removed");
  if (!dataset_.empty() && Clock::now() - last_ < patience_) throw InputError("upload", "dataset", dataset, "to wait until " + dataset_ + " is there, or to cancel it");
  drop();
  ++number_;
  std::error_code error;
  fs::create_directories(folder(), error);
  if (error) throw InputError("upload", "folder", datasets_ + " (" + error.message() + ")", "a folder that can be written");
  dataset_ = dataset, files_ = std::move(files), last_ = Clock::now();
  return status();
}

void DatasetUpload::expect_current(unsigned long upload) const {
  if (dataset_.empty() || upload != number_) throw InputError("upload", "upload", std::to_string(upload) + ", which has ended", "an upload that is under way");
}

Json DatasetUpload::part(std::string_view where, const std::string& bytes) {
  const auto [upload, index, offset] = numbers_in(where);
  expect_current(upload);
  if (index >= files_.size()) throw InputError("upload", "file", std::to_string(index), "one of " + std::to_string(files_.size()) + " files");
  File& file = files_[index];
  if (offset != file.received) throw InputError("upload", "offset", std::to_string(offset), std::to_string(file.received) + ", where " + file.name + " ends so far");
  if (bytes.empty() || bytes.size() > file.bytes - file.received) throw InputError("upload", "part", std::to_string(bytes.size()) + " bytes", "1 to " + std::to_string(file.bytes - file.received) + " more of " + file.name);
  if (const int error = append(folder() + "/" + file.name, bytes)) {
    drop();
    throw InputError("upload", "disk", std::string(std::strerror(error)) + "; what was sent is removed", "room for the whole dataset in " + datasets_);
  }
  file.received += bytes.size();
  last_ = Clock::now();
  return status();
}

Json DatasetUpload::finish(const std::string& body) {
  expect_current(number_in(body));
  for (const File& file : files_) {
    if (file.received != file.bytes) throw InputError("upload", "bytes", std::to_string(file.received) + " of " + file.name, std::to_string(file.bytes));
    if (file.bytes == 0) append(folder() + "/" + file.name, "");
  }
  const fs::path to = fs::path(datasets_) / dataset_;
  std::error_code error;
  if (fs::exists(to)) error = std::make_error_code(std::errc::file_exists);
  else fs::rename(folder(), to, error);
  const std::string dataset = dataset_;
  drop();
  if (error) throw InputError("upload", "dataset", dataset + " (" + error.message() + ")", "a name that is free in " + datasets_);
  return status();
}

Json DatasetUpload::cancel(const std::string& body) {
  if (number_in(body) == number_) drop();
  return status();
}

}  // namespace filum
