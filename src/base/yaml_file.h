#pragma once
// Typed, strict reading of YAML: every field is asked for with its unit and range, unknown keys are refused
// by finish(), and every error is an InputError that names "FILE:LINE" (with the column where it is no YAML), the dotted path of the field, the
// value found and what was expected. Size, depth and number of values are bounded; anchors, aliases, tags,
// repeated keys and more than one document are refused.
//
//   YamlNode file = YamlNode::load("models/suture/10-0-nylon.yaml");
//   const double diameter = file.quantity("diameter", "um", Range::positive());
//   file.finish();

#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/pose.h"

namespace filum {

/// Closed interval in SI units, unless a bound is open.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_open = false;
  bool contains(double value) const { return (low_open ? value > low : value >= low) && value <= high; }
  static Range positive() { return {0.0, std::numeric_limits<double>::infinity(), true}; }
  static Range not_negative() { return {0.0, std::numeric_limits<double>::infinity(), false}; }
  static Range between(double low, double high) { return {low, high, false}; }
};

class YamlNode {
 public:
  /// Throws InputError if the file cannot be read or is not one YAML document whose top is a map.
  static YamlNode load(const std::string& path);
  static YamlNode parse(std::string_view text, const std::string& file_name);

  // Fields of a map. Those without "_or" are required.
  bool has(const std::string& key) const;
  double quantity(const std::string& key, std::string_view unit, Range range = {}) const;
  double quantity_or(const std::string& key, std::string_view unit, double otherwise, Range range = {}) const;
  double number(const std::string& key, Range range = {}) const { return quantity(key, "-", range); }
  double number_or(const std::string& key, double otherwise, Range range = {}) const;
  int integer(const std::string& key, int low, int high) const;
  int integer_or(const std::string& key, int otherwise, int low, int high) const;
  std::string text(const std::string& key) const;
  std::string text_or(const std::string& key, const std::string& otherwise) const;
  /// One of the words listed.
  std::string choice(const std::string& key, const std::vector<std::string>& words) const;
  bool flag(const std::string& key) const;
  bool flag_or(const std::string& key, bool otherwise) const;
  /// "[1 mm, 0 mm, -2 mm]"
  Vec3 vec3(const std::string& key, std::string_view unit) const;
  Vec3 vec3_or(const std::string& key, std::string_view unit, const Vec3& otherwise) const;
  std::vector<double> quantities(const std::string& key, std::string_view unit, Range range = {}) const;
  std::vector<std::string> texts(const std::string& key) const;
  /// Every scalar below a key, however deep: for fields whose form is free.
  std::vector<std::string> scalars(const std::string& key) const;
  /// A map inside this one.
  YamlNode map(const std::string& key) const;
  /// The elements of a list of maps; `items_or_none` gives an empty list when the key is absent.
  std::vector<YamlNode> items(const std::string& key) const;
  std::vector<YamlNode> items_or_none(const std::string& key) const;
  /// Keys in the order of the file, for maps whose keys are names.
  std::vector<std::string> keys() const;

  /// Refuses keys that nobody asked for, with those that were, here and in every map and list item that was opened below.
  void finish() const;

  /// For checks that only the caller can make: refuse("bite", "less than the wall's thickness").
  [[noreturn]] void refuse(const std::string& key, const std::string& expected) const;
  /// "FILE:LINE" and dotted path of this node.
  std::string where() const;
  const std::string& path() const { return path_; }

 private:
  struct Value;
  struct Document;
  friend class YamlBuilder;

  YamlNode(std::shared_ptr<Document> document, Value* value, std::string path);
  Value* find(const std::string& key) const;
  Value& require(const std::string& key, const std::string& expected) const;
  const std::string& scalar(const std::string& key, const std::string& expected) const;
  const std::vector<std::unique_ptr<Value>>& list(const std::string& key, const std::string& expected) const;
  std::string below(const std::string& key) const;
  double read_quantity(const Value& value, const std::string& path, std::string_view unit, Range range) const;
  [[noreturn]] void fail(const Value& value, const std::string& path, const std::string& expected) const;

  std::shared_ptr<Document> document_;
  Value* value_;
  std::string path_;
};

}  // namespace filum
