#include "cli/camera_plan.h"

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "cli/requests.h"

namespace filum {
namespace {

using Json = nlohmann::ordered_json;

[[noreturn]] void refuse(const Json& wish, const char* key, const char* expected) {
  throw InputError("camera", key, json_shown(wish[key]), expected);
}

}  // namespace

CameraPlan camera_plan(const std::string& text, const std::string& program, const std::string& folder, const std::string& fixed_source) {
  if (program.empty()) throw InputError("camera", "program", "none", "filum_camera beside this program (built where OpenCV is)");
  const Json wish = parsed_json(text);
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

}  // namespace filum
