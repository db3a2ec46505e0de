#include "cli/calibration_plan.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "cli/requests.h"

namespace filum {
namespace {

using Json = nlohmann::ordered_json;

std::vector<double> growing(const Json& wish, const char* key, std::vector<double> otherwise, double most) {
  if (!wish.contains(key)) return otherwise;
  const auto refuse = [&] { throw InputError("calibration", key, json_shown(wish[key]), "5 to 20 growing numbers from " + std::to_string(-most) + " to " + std::to_string(most)); };
  if (!wish[key].is_array() || wish[key].size() < 5 || wish[key].size() > 20) refuse();
  std::vector<double> values;
  for (const Json& v : wish[key]) {
    if (!v.is_number() || std::abs(v.get<double>()) > most || (!values.empty() && v.get<double>() <= values.back())) refuse();
    values.push_back(v.get<double>());
  }
  return values;
}

std::string word(const Json& wish, const char* key, const std::string& otherwise) {
  if (!wish.contains(key)) return otherwise;
  const std::string text = wish[key].is_string() ? wish[key].get<std::string>() : "";
  const auto allowed = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_' || c == '.'; };
  if (text.empty() || text.size() > 40 || !std::all_of(text.begin(), text.end(), allowed))
    throw InputError("calibration", key, json_shown(wish[key]), "up to 40 letters, digits, dots and dashes");
  return text;
}

}  // namespace

CalibrationPlan calibration_plan(const std::string& text, std::string port, std::string root, std::string folder) {
  const Json wish = parsed_json(text);
  if (!wish.is_object()) throw InputError("calibration", "body", text.substr(0, 80), "a JSON object");
  CalibrationPlan plan;
  plan.port = std::move(port);
  plan.root = std::move(root);
  plan.folder = std::move(folder);
  plan.sensor = word(wish, "sensor", plan.sensor);
  plan.name = word(wish, "name", plan.name);
  plan.angles = growing(wish, "angles", plan.angles, 60.0);
  plan.forces = growing(wish, "forces", plan.forces, 20.0);
  if (wish.contains("repeats")) {
    if (!wish["repeats"].is_number_integer() || wish["repeats"] < 2 || wish["repeats"] > 20)
      throw InputError("calibration", "repeats", json_shown(wish["repeats"]), "a whole number from 2 to 20");
    plan.repeats = wish["repeats"].get<int>();
  }
  if (wish.contains("identity")) {
    if (!wish["identity"].is_number_integer() || wish["identity"] < 1 || wish["identity"] > 2147483647)
      throw InputError("calibration", "identity", json_shown(wish["identity"]), "a whole number from 1 to 2147483647");
    plan.identity = wish["identity"].get<unsigned>();
  }
  return plan;
}

}  // namespace filum
