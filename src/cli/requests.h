#pragma once
// JSON that pages send and recordings carry, read before anybody acts on it. Test: tests/cli/requests_test.cpp, requests_fuzz.cpp.

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "session/ratings.h"

namespace filum {

inline constexpr int kJsonDepth = 64;

/// The document of a text; "discarded" where it is no JSON or nested deeper than kJsonDepth: copying and printing go down the nesting, and the
/// stack with them.
nlohmann::ordered_json parsed_json(const std::string& text);
/// One line; bytes that are no text do not break it.
std::string json_text(const nlohmann::ordered_json& document);
/// What was found in place of something else: at most 80 bytes.
std::string json_shown(const nlohmann::ordered_json& value);
/// The same of what stands under a name; "nothing" where there is no such name.
std::string json_shown_at(const nlohmann::ordered_json& object, const std::string& name);

/// A text, or a list of texts, of a request's object. Throw InputError.
std::string requested_text(const std::string& body, const char* name);
std::vector<std::string> requested_names(const std::string& body, const char* name);

/// The list of rating scales that a result carries, as it stands there, or the one `scale` of earlier programs.
nlohmann::ordered_json scales_of(const nlohmann::ordered_json& result);
/// The one of that name. Throws InputError.
const nlohmann::ordered_json& scale_named(const nlohmann::ordered_json& scales, const std::string& name);
/// A rater's code, the name of one of the session's scales, and marks, one for each of its items. Throws InputError; `scales`, from a recording,
/// may be damaged: then a JSON library's exception (std::exception).
Rating requested_rating(const std::string& session, const std::string& task, const nlohmann::ordered_json& scales, const std::string& body);

}  // namespace filum
