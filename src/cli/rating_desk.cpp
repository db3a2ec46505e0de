#include "cli/rating_desk.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "analysis/agreement.h"
#include "base/error.h"
#include "cli/options.h"
#include "cli/requests.h"
#include "session/store.h"

namespace filum {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kRatings = "/api/ratings/", kDocuments = "/documents/agreement/";

Json marks_json(const Rating& rating) {
  Json marks = Json::object();
  for (const ItemMark& m : rating.marks) marks[m.item] = m.points;
  return {{"scale", rating.scale}, {"rater", rating.rater}, {"stored", rating.stored_utc}, {"marks", marks}};
}

std::vector<ItemMark> estimates_of(const Json& scale) {
  std::vector<ItemMark> marks;
  for (const Json& item : scale.at("items"))
    if (item.at("estimate").is_number_integer()) marks.push_back({item.at("name").get<std::string>(), item["estimate"].get<int>()});
  return marks;
}

}  // namespace

RatingDesk::RatingDesk(const std::string& folder, std::function<std::optional<std::string>(const std::string&)> result_of) : result_of_(std::move(result_of)) {
  try {
    ratings_ = std::make_unique<Ratings>(folder);
  } catch (const StoreError&) {
    throw;
  } catch (const InputError& error) {
    trouble_ = error.what();
  }
}

Json RatingDesk::status(const std::string& session, const Json& result) const {
  Json given = Json::array();
  if (ratings_)
    for (const Rating& r : ratings_->list(session)) given.push_back(marks_json(r));
  return {{"session", session},
          {"task", result.value("task", "")},
          {"title", result.value("title", "")},
          {"scales", scales_of(result)},
          {"ratings", given},
          {"trouble", trouble_}};
}

void RatingDesk::put(const std::string& session, const Json& result, const std::string& body) {
  if (!ratings_) throw InputError("rating", "store", trouble_, "a file of ratings that can be written");
  const Json scales = scales_of(result);
  Rating r = requested_rating(session, result.value("task", ""), scales, body);
  if (r.rater == kSimulatorCode) throw InputError("rating", "rater", r.rater, "a code that is not the simulator's");
  const std::vector<Rating> before = ratings_->list(session);
  const bool first = std::none_of(before.begin(), before.end(), [&](const Rating& one) { return one.scale == r.scale; });
  ratings_->put(r);
  r.marks = estimates_of(scale_named(scales, r.scale));
  r.rater = kSimulatorCode;
  if (first && !r.marks.empty()) ratings_->put(r);
}

std::optional<std::string> RatingDesk::get(std::string_view path) {
  if (path == "/api/agreement") {
    const std::vector<Rating> all = ratings_ ? ratings_->list() : std::vector<Rating>();
    Json json = agreement_json(agreements(all), all);
    json["trouble"] = trouble_;
    return json_text(json);
  }
  return answer(path, nullptr);
}

std::optional<std::string> RatingDesk::post(std::string_view path, const std::string& body) { return answer(path, &body); }

/// The session's ratings, after those of `body` where there is one. A result comes out of a recording, which may be damaged.
std::optional<std::string> RatingDesk::answer(std::string_view path, const std::string* body) {
  if (!path.starts_with(kRatings)) return std::nullopt;
  const std::string session(path.substr(kRatings.size()));
  const auto text = result_of_(session);
  if (!text) return std::nullopt;
  try {
    Json result = parsed_json(*text);
    if (!result.is_object()) result = Json::object();
    if (body != nullptr) put(session, result, *body);
    return json_text(status(session, result));
  } catch (const InputError& error) {
    return json_text({{"refused", error.field + ": found " + error.value + ", expected " + error.expected}});
  } catch (const std::exception& error) {
    return json_text({{"refused", error.what()}});
  }
}

std::optional<Document> RatingDesk::document(std::string_view path) {
  if (!path.starts_with(kDocuments) || !ratings_) return std::nullopt;
  path.remove_prefix(kDocuments.size());
  const std::vector<Rating> all = ratings_->list();
  if (path == "agreement.csv") return Document{"text/csv; charset=utf-8", agreement_csv(agreements(all))};
  if (path == "ratings.csv") return Document{"text/csv; charset=utf-8", ratings_csv(all)};
  if (path == "agreement.json") return Document{"application/json", json_text(agreement_json(agreements(all), all))};
  return std::nullopt;
}

}  // namespace filum
