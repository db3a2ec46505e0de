#pragma once
// Compares a JSON value with src/server/messages.schema.json. Covers the words that file uses; an unknown word is a fault, so
// that the schema cannot outgrow the check unnoticed.

#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <string>

namespace filum {

class SchemaCheck {
 public:
  SchemaCheck() {
    std::ifstream file(std::string(FILUM_SOURCE_DIR) + "/src/server/messages.schema.json");
    schema_ = nlohmann::json::parse(file);
  }

  /// Empty if `value` is a `definition`; else the first fault.
  std::string fault(const nlohmann::json& value, const std::string& definition) const {
    return check(value, {{"$ref", "#/$defs/" + definition}}, definition);
  }
  const nlohmann::json& definitions() const { return schema_.at("$defs"); }

 private:
  using json = nlohmann::json;

  std::string check(const json& value, const json& schema, const std::string& at) const {
    for (const auto& [word, rule] : schema.items()) {
      const std::string fault = check_word(value, schema, word, rule, at);
      if (!fault.empty()) return fault;
    }
    return {};
  }

  std::string check_word(const json& v, const json& schema, const std::string& word, const json& rule, const std::string& at) const {
    const auto unless = [&at, &word](bool good) { return good ? std::string() : at + ": " + word; };
    if (word == "description") return {};
    if (word == "$ref") {
      const std::string name = rule.get<std::string>().substr(std::string("#/$defs/").size());
      return check(v, schema_.at("$defs").at(name), at);
    }
    if (word == "type") return unless(has_type(v, rule));
    if (word == "const") return unless(v == rule);
    if (word == "enum") return unless(std::find(rule.begin(), rule.end(), v) != rule.end());
    if (word == "minimum") return unless(!v.is_number() || v.get<double>() >= rule.get<double>());
    if (word == "maximum") return unless(!v.is_number() || v.get<double>() <= rule.get<double>());
    if (word == "minItems") return unless(!v.is_array() || v.size() >= rule.get<std::size_t>());
    if (word == "maxItems") return unless(!v.is_array() || v.size() <= rule.get<std::size_t>());
    if (word == "minLength") return unless(!v.is_string() || v.get<std::string>().size() >= rule.get<std::size_t>());
    if (word == "maxLength") return unless(!v.is_string() || v.get<std::string>().size() <= rule.get<std::size_t>());
    if (word == "pattern") return unless(!v.is_string() || std::regex_search(v.get<std::string>(), std::regex(rule.get<std::string>())));
    if (word == "anyOf" || word == "oneOf") return check_choice(v, word, rule, at);
    if (word == "required") return check_required(v, rule, at);
    if (word == "items") return check_items(v, rule, at);
    if (word == "properties") return check_properties(v, rule, at);
    if (word == "additionalProperties") return check_no_more(v, schema.at("properties"), at);
    return at + ": the check does not know the word " + word;
  }

  static bool has_type(const json& v, const std::string& type) {
    if (type == "object") return v.is_object();
    if (type == "array") return v.is_array();
    if (type == "string") return v.is_string();
    if (type == "number") return v.is_number();
    if (type == "integer") return v.is_number_integer();
    if (type == "boolean") return v.is_boolean();
    return type == "null" && v.is_null();
  }

  std::string check_choice(const json& v, const std::string& word, const json& rule, const std::string& at) const {
    std::string faults;
    int matches = 0;
    for (const json& option : rule) {
      const std::string fault = check(v, option, at);
      matches += fault.empty();
      faults += " | " + fault;
    }
    return matches == 1 || (matches > 1 && word == "anyOf") ? std::string() : at + ": " + word + faults;
  }

  static std::string check_required(const json& v, const json& rule, const std::string& at) {
    if (!v.is_object()) return {};
    for (const json& name : rule) {
      if (!v.contains(name.get<std::string>())) return at + ": lacks " + name.get<std::string>();
    }
    return {};
  }

  std::string check_items(const json& v, const json& rule, const std::string& at) const {
    if (!v.is_array()) return {};
    for (std::size_t i = 0; i < v.size(); ++i) {
      const std::string fault = check(v[i], rule, at + "[" + std::to_string(i) + "]");
      if (!fault.empty()) return fault;
    }
    return {};
  }

  std::string check_properties(const json& v, const json& rule, const std::string& at) const {
    if (!v.is_object()) return {};
    for (const auto& [name, schema] : rule.items()) {
      if (!v.contains(name)) continue;
      const std::string fault = check(v.at(name), schema, at + "." + name);
      if (!fault.empty()) return fault;
    }
    return {};
  }

  static std::string check_no_more(const json& v, const json& properties, const std::string& at) {
    if (!v.is_object()) return {};
    for (const auto& [name, value] : v.items()) {
      if (!properties.contains(name)) return at + ": has the unknown field " + name;
    }
    return {};
  }

  json schema_;
};

}  // namespace filum
