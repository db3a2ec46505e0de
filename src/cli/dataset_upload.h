#pragma once
// Measurements on their way from a browser into the folder of datasets: begun with the list of their files, sent in parts one after another, put
// in their place when all are there. Until then they stand in a folder beside, which no list shows. One at a time; called by the server's thread.

#include <chrono>
#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace filum {

inline constexpr std::size_t kUploadFiles = 200;
inline constexpr std::size_t kUploadBytes = 256 * 1024 * 1024;  // of all files

class DatasetUpload {
 public:
  /// `datasets`: folder of the datasets, made when needed. What an earlier trainer left half sent is removed.
  /// `patience`: so long without a part, and another may begin.
  explicit DatasetUpload(std::string datasets, std::chrono::milliseconds patience = std::chrono::seconds(30));
  /// What is half sent is removed.
  ~DatasetUpload();
  DatasetUpload(const DatasetUpload&) = delete;
  DatasetUpload& operator=(const DatasetUpload&) = delete;

  // All throw InputError, and tell {"upload": number, "bytes": received, "of": all}.
  /// {"dataset": name, "files": [{"name", "bytes"}]}; a name has letters, digits, dots, dashes, and exists nowhere yet.
  nlohmann::ordered_json begin(const std::string& body);
  /// `where`: "UPLOAD/FILE/OFFSET", the file by its number in the list, the offset where its last part ended. A part that
  /// cannot be stored (no room on the disk) ends the upload.
  nlohmann::ordered_json part(std::string_view where, const std::string& bytes);
  /// {"upload": number}: all is there.
  nlohmann::ordered_json finish(const std::string& body);
  /// {"upload": number}; one that has ended already is no fault.
  nlohmann::ordered_json cancel(const std::string& body);

 private:
  struct File {
    std::string name;
    std::size_t bytes = 0, received = 0;
  };
  nlohmann::ordered_json status() const;
  std::string folder() const;  // of what is half sent
  void expect_current(unsigned long upload) const;
  void drop();

  const std::string datasets_;
  const std::chrono::milliseconds patience_;
  std::string dataset_;  // empty: none under way
  std::vector<File> files_;
  unsigned long number_ = 0;
  std::chrono::steady_clock::time_point last_;
};

}  // namespace filum
