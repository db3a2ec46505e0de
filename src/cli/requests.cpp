#include "cli/requests.h"

#include <nlohmann/json.hpp>

#include "base/error.h"

namespace filum {
namespace {

using Json = nlohmann::ordered_json;

struct TooDeep {};

constexpr int kMostPoints = 100;  // of an item of a scale

std::vector<ItemMark> marks_of(const Json& scale, const Json& given) {
  if (!given.is_object()) throw InputError("rating", "marks", given.is_null() ? "nothing" : json_shown(given), "points for every item");
  const Json& high = scale.at("most");
  if (!high.is_number_unsigned() || high > kMostPoints) throw InputError("scale", "most", json_shown(high), "a whole number from 1 to " + std::to_string(kMostPoints));
  const int most = high.get<int>();
  std::vector<ItemMark> marks;
  for (const Json& item : scale.at("items")) {
    const auto name = item.at("name").get<std::string>();
    const std::string expected = "a whole number from 0 to " + std::to_string(most);
    if (!given.contains(name) || !given[name].is_number_integer()) throw InputError("rating", name, json_shown_at(given, name), expected);
    const auto points = given[name].get<std::int64_t>();
    if (points < 0 || points > most) throw InputError("rating", name, std::to_string(points), expected);
    marks.push_back({name, static_cast<int>(points)});
  }
  if (given.size() != marks.size()) throw InputError("rating", "marks", std::to_string(given.size()) + " items", "the items of the scale");
  return marks;
}

}  // namespace

Json parsed_json(const std::string& text) {
  using Event = Json::parse_event_t;
  const auto shallow = [](int around, Event event, Json&) -> bool {
    if (around >= kJsonDepth && (event == Event::array_start || event == Event::object_start)) throw TooDeep();
    return true;
  };
  try {
    return Json::parse(text, shallow, false);
  } catch (const TooDeep&) {
    return Json(Json::value_t::discarded);
  }
}

std::string json_text(const Json& document) { return document.dump(-1, ' ', false, Json::error_handler_t::replace); }

std::string json_shown(const Json& value) { return json_text(value).substr(0, 80); }

std::string json_shown_at(const Json& object, const std::string& name) { return object.is_object() && object.contains(name) ? json_shown(object[name]) : "nothing"; }

std::string requested_text(const std::string& body, const char* name) {
  const Json json = parsed_json(body);
  if (!json.is_object() || !json.contains(name) || !json[name].is_string()) throw InputError("request", name, json_shown_at(json, name), "a text");
  return json[name].get<std::string>();
}

std::vector<std::string> requested_names(const std::string& body, const char* name) {
  const Json json = parsed_json(body);
  if (!json.is_object() || !json.contains(name) || !json[name].is_array()) throw InputError("request", name, json_shown_at(json, name), "a list of sessions");
  std::vector<std::string> list;
  for (const Json& one : json[name]) {
    if (!one.is_string()) throw InputError("request", name, json_shown(one), "identifiers of sessions");
    list.push_back(one.get<std::string>());
  }
  return list;
}

Json scales_of(const Json& result) {
  if (!result.is_object()) return Json::array();
  if (result.contains("scales")) return result["scales"];
  return result.contains("scale") ? Json::array({result["scale"]}) : Json::array();
}

const Json& scale_named(const Json& scales, const std::string& name) {
  std::string names;
  for (const Json& one : scales) {
    if (one.at("name") == name) return one;
    names += (names.empty() ? "" : ", ") + one.at("name").get<std::string>();
  }
  throw InputError("rating", "scale", json_shown(name), "one of the session's scales: " + names);
}

Rating requested_rating(const std::string& session, const std::string& task, const Json& scales, const std::string& body) {
  if (!scales.is_array()) throw InputError("result", "scales", json_shown(scales), "a list of rating scales");
  if (scales.empty()) throw InputError("rating", "scale", "none", "a session of a task that has a rating scale");
  const Json wish = parsed_json(body);
  if (!wish.is_object() || !wish.contains("rater") || !wish["rater"].is_string()) throw InputError("rating", "rater", json_shown_at(wish, "rater"), "the rater's code");
  if (!wish.contains("scale") || !wish["scale"].is_string()) throw InputError("rating", "scale", json_shown_at(wish, "scale"), "the name of one of the session's scales");
  const Json& scale = scale_named(scales, wish["scale"].get<std::string>());
  Rating r{session, task, scale.at("name").get<std::string>(), wish["rater"].get<std::string>(), "", {}};
  r.marks = marks_of(scale, wish.contains("marks") ? wish["marks"] : Json(nullptr));
  return r;
}

}  // namespace filum
