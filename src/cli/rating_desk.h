#pragma once
// Where raters mark stored sessions, and where their marks are compared with each other and with the simulator's estimates.
//   GET  /api/ratings/SESSION   the scales of that session, with estimates, and the marks given so far
//   POST /api/ratings/SESSION   {"rater": code, "scale": name, "marks": {item: points}}: every item of one of the scales
//   GET  /api/agreement, /documents/agreement/{agreement.csv,agreement.json,ratings.csv}
// Called by the server's thread only. Test: tests/cli/rating_desk_test.cpp.

#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "server/server.h"
#include "session/ratings.h"

namespace filum {

class RatingDesk {
 public:
  /// `result_of`: JSON text of a stored session's result, or nothing. A folder whose ratings cannot be opened is told with every answer;
  /// ratings of a newer program throw StoreError.
  RatingDesk(const std::string& folder, std::function<std::optional<std::string>(const std::string&)> result_of);

  /// Why no rating can be given, empty: they can.
  const std::string& trouble() const { return trouble_; }

  std::optional<std::string> get(std::string_view path);
  std::optional<std::string> post(std::string_view path, const std::string& body);
  std::optional<Document> document(std::string_view path);

 private:
  std::optional<std::string> answer(std::string_view path, const std::string* body);
  nlohmann::ordered_json status(const std::string& session, const nlohmann::ordered_json& result) const;
  void put(const std::string& session, const nlohmann::ordered_json& result, const std::string& body);

  std::function<std::optional<std::string>(const std::string&)> result_of_;
  std::unique_ptr<Ratings> ratings_;
  std::string trouble_;
};

}  // namespace filum
