#include "base/yaml_file.h"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "base/error.h"
#include "base/units.h"
#include "base/utf8.h"

namespace filum {
namespace {

constexpr std::size_t kMaxBytes = 4u << 20;
constexpr std::size_t kMaxValues = 200000;
constexpr std::size_t kMaxDepth = 24;

std::string shown(const std::string& text) {
  std::string out;
  for (const char c : text.substr(0, 60)) out += (static_cast<unsigned char>(c) < 0x20 ? '?' : c);
  return "\"" + out + (text.size() > 60 ? "...\"" : "\"");
}

std::string bound_text(double value, std::string_view unit) {
  return format_quantity(value, unit, 6);
}

std::string expected_range(std::string_view unit, const Range& range) {
  std::string text = unit == "-" ? "a number" : "a quantity like 1.5 " + std::string(unit);
  const bool below = std::isfinite(range.high);
  const bool above = std::isfinite(range.low);
  if (above) text += (range.low_open ? " above " : " of at least ") + bound_text(range.low, unit);
  if (below) text += std::string(above ? " and" : "") + " at most " + bound_text(range.high, unit);
  return text;
}

}  // namespace

struct YamlNode::Value {
  enum class Kind { scalar, list, map };
  Kind kind = Kind::scalar;
  std::string scalar;
  std::vector<std::string> keys;  // of a map, one for each child
  std::vector<std::unique_ptr<Value>> children;
  std::vector<bool> used;  // of a map: the key was asked for
  std::vector<std::string> asked;  // of a map: every key that was asked for, there or not, in that order
  bool opened = false;     // a YamlNode was handed out for it
  int line = 1;

  std::string described() const {
    if (kind == Kind::scalar) return shown(scalar);
    if (kind == Kind::map) return "a map";
    const auto is_scalar = [](const std::unique_ptr<Value>& child) { return child->kind == Kind::scalar; };
    if (children.size() > 4 || !std::all_of(children.begin(), children.end(), is_scalar)) return "a list";
    std::string all;
    for (const auto& child : children) all += (all.empty() ? "[" : ", ") + shown(child->scalar);
    return all.empty() ? "an empty list" : all + "]";
  }
};

struct YamlNode::Document {
  std::string file;
  Value root;
};

/// Builds our own tree from the parser's events, so that the bounds hold while parsing and each value knows
/// its line.
class YamlBuilder final : public YAML::EventHandler {
 public:
  using Value = YamlNode::Value;
  explicit YamlBuilder(YamlNode::Document& document) : document_(document) {}

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    check(mark, "", anchor);
    add_scalar(mark, "");
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override { refuse(mark, "an alias", "no aliases"); }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    check(mark, tag, anchor);
    add_scalar(mark, value);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    check(mark, tag, anchor);
    open(mark, Value::Kind::list);
  }
  void OnSequenceEnd() override { stack_.pop_back(); }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    check(mark, tag, anchor);
    open(mark, Value::Kind::map);
  }
  void OnMapEnd() override { stack_.pop_back(); }

 private:
  struct Level {
    Value* value;
    bool key_next;  // of a map: the next scalar is a key
  };

  [[noreturn]] void refuse(const YAML::Mark& mark, const std::string& found,
                           const std::string& expected) const {
    throw InputError(document_.file + ":" + std::to_string(mark.line + 1), "YAML", found, expected);
  }

  void check(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor) {
    if (anchor != 0) refuse(mark, "an anchor", "no anchors");
    if (!tag.empty() && tag != "?" && tag != "!") refuse(mark, "the tag " + shown(tag), "no tags");
    if (++count_ > kMaxValues) refuse(mark, "more values", "at most " + std::to_string(kMaxValues));
    if (stack_.size() >= kMaxDepth)
      refuse(mark, "deeper nesting", "at most " + std::to_string(kMaxDepth) + " levels");
  }

  /// The value to fill next: the root or a new child of the innermost list or map.
  Value* place(const YAML::Mark& mark) {
    Value* value = &document_.root;
    if (!stack_.empty()) {
      Level& level = stack_.back();
      if (level.value->kind == Value::Kind::map) {
        if (level.key_next) refuse(mark, "a list or map as a key", "a plain word as a key");
        level.key_next = true;
      }
      level.value->children.push_back(std::make_unique<Value>());
      value = level.value->children.back().get();
    }
    value->line = mark.line + 1;
    return value;
  }

  void add_scalar(const YAML::Mark& mark, const std::string& text) {
    if (!stack_.empty() && stack_.back().value->kind == Value::Kind::map && stack_.back().key_next) {
      Value& map = *stack_.back().value;
      for (const std::string& key : map.keys)
        if (key == text) refuse(mark, "the key " + shown(text) + " twice", "each key once");
      map.keys.push_back(text);
      map.used.push_back(false);
      stack_.back().key_next = false;
      return;
    }
    place(mark)->scalar = text;
  }

  void open(const YAML::Mark& mark, Value::Kind kind) {
    Value* value = place(mark);
    value->kind = kind;
    stack_.push_back({value, true});
  }

  YamlNode::Document& document_;
  std::vector<Level> stack_;
  std::size_t count_ = 0;
};

YamlNode::YamlNode(std::shared_ptr<Document> document, Value* value, std::string path)
    : document_(std::move(document)), value_(value), path_(std::move(path)) {
  value_->opened = true;
}

YamlNode YamlNode::load(const std::string& path) {
  std::error_code none;
  const auto status = std::filesystem::status(path, none);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
    throw InputError(path, "file", std::filesystem::is_directory(status) ? "a folder" : "a pipe or a device", "a YAML file");
  std::ifstream file(path, std::ios::binary);
  if (!file) throw InputError(path, "file", "nothing that can be read", "a YAML file");
  std::string text;
  char block[65536];
  while (text.size() <= kMaxBytes && (file.read(block, sizeof block) || file.gcount() > 0))
    text.append(block, static_cast<std::size_t>(file.gcount()));
  if (file.bad()) throw InputError(path, "file", "a read error", "a YAML file");
  return parse(text, path);
}

YamlNode YamlNode::parse(std::string_view text, const std::string& file_name) {
  auto document = std::make_shared<Document>();
  document->file = file_name;
  if (text.size() > kMaxBytes)
    throw InputError(file_name, "file", "more than 4 MiB", "a YAML file of at most 4 MiB");
  require_utf8(text, file_name, "a YAML file");
  try {
    std::istringstream stream{std::string(text)};
    YAML::Parser parser(stream);
    YamlBuilder builder(*document);
    if (!parser.HandleNextDocument(builder))
      throw InputError(file_name + ":1", "YAML", "an empty file", "a map of fields");
    if (parser) throw InputError(file_name, "YAML", "more than one document", "one document");
  } catch (const YAML::Exception& error) {
    const int line = error.mark.is_null() ? 1 : error.mark.line + 1;
    const std::string column = error.mark.is_null() ? "" : ":" + std::to_string(error.mark.column + 1);
    throw InputError(file_name + ":" + std::to_string(line) + column, "YAML", error.msg, "well-formed YAML");
  }
  if (document->root.kind != Value::Kind::map)
    throw InputError(file_name + ":1", "YAML", document->root.described(), "a map of fields");
  Value* root = &document->root;
  return YamlNode(std::move(document), root, "");
}

std::string YamlNode::below(const std::string& key) const {
  return path_.empty() ? key : path_ + "." + key;
}

std::string YamlNode::where() const {
  return document_->file + ":" + std::to_string(value_->line) + (path_.empty() ? "" : ": " + path_);
}

void YamlNode::fail(const Value& value, const std::string& path, const std::string& expected) const {
  throw InputError(document_->file + ":" + std::to_string(value.line), path, value.described(), expected);
}

void YamlNode::refuse(const std::string& key, const std::string& expected) const {
  const Value* value = find(key);
  if (value == nullptr)
    throw InputError(document_->file + ":" + std::to_string(value_->line), below(key), "nothing", expected);
  fail(*value, below(key), expected);
}

YamlNode::Value* YamlNode::find(const std::string& key) const {
  if (value_->kind != Value::Kind::map) return nullptr;
  if (std::find(value_->asked.begin(), value_->asked.end(), key) == value_->asked.end()) value_->asked.push_back(key);
  for (std::size_t i = 0; i < value_->children.size(); ++i) {
    if (value_->keys[i] != key) continue;
    value_->used[i] = true;
    return value_->children[i].get();
  }
  return nullptr;
}

YamlNode::Value& YamlNode::require(const std::string& key, const std::string& expected) const {
  Value* value = find(key);
  if (value == nullptr) refuse(key, expected);
  return *value;
}

const std::string& YamlNode::scalar(const std::string& key, const std::string& expected) const {
  const Value& value = require(key, expected);
  if (value.kind != Value::Kind::scalar) fail(value, below(key), expected);
  return value.scalar;
}

const std::vector<std::unique_ptr<YamlNode::Value>>& YamlNode::list(const std::string& key,
                                                                    const std::string& expected) const {
  const Value& value = require(key, expected);
  if (value.kind != Value::Kind::list) fail(value, below(key), expected);
  return value.children;
}

double YamlNode::read_quantity(const Value& value, const std::string& path, std::string_view unit,
                               Range range) const {
  const std::string expected = expected_range(unit, range);
  if (value.kind != Value::Kind::scalar) fail(value, path, expected);
  double result = 0.0;
  try {
    result = parse_quantity(value.scalar, unit);
  } catch (const InputError&) {
    fail(value, path, expected);
  }
  if (!range.contains(result)) fail(value, path, expected);
  return result;
}

bool YamlNode::has(const std::string& key) const {
  return find(key) != nullptr;
}

double YamlNode::quantity(const std::string& key, std::string_view unit, Range range) const {
  return read_quantity(require(key, expected_range(unit, range)), below(key), unit, range);
}

double YamlNode::quantity_or(const std::string& key, std::string_view unit, double otherwise,
                             Range range) const {
  return has(key) ? quantity(key, unit, range) : otherwise;
}

double YamlNode::number_or(const std::string& key, double otherwise, Range range) const {
  return quantity_or(key, "-", otherwise, range);
}

int YamlNode::integer(const std::string& key, int low, int high) const {
  const std::string expected = "a whole number from " + std::to_string(low) + " to " + std::to_string(high);
  const std::string& text = scalar(key, expected);
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value < low || value > high)
    refuse(key, expected);
  return value;
}

int YamlNode::integer_or(const std::string& key, int otherwise, int low, int high) const {
  return has(key) ? integer(key, low, high) : otherwise;
}

std::string YamlNode::text(const std::string& key) const {
  const std::string& value = scalar(key, "a text");
  if (value.empty()) refuse(key, "a text that is not empty");
  return value;
}

std::string YamlNode::text_or(const std::string& key, const std::string& otherwise) const {
  return has(key) ? scalar(key, "a text") : otherwise;
}

std::string YamlNode::choice(const std::string& key, const std::vector<std::string>& words) const {
  std::string expected = "one of";
  for (const std::string& word : words) expected += " " + word;
  const std::string& value = scalar(key, expected);
  for (const std::string& word : words)
    if (word == value) return value;
  refuse(key, expected);
}

bool YamlNode::flag(const std::string& key) const {
  const std::string& value = scalar(key, "true or false");
  if (value == "true" || value == "yes") return true;
  if (value == "false" || value == "no") return false;
  refuse(key, "true or false");
}

bool YamlNode::flag_or(const std::string& key, bool otherwise) const {
  return has(key) ? flag(key) : otherwise;
}

Vec3 YamlNode::vec3(const std::string& key, std::string_view unit) const {
  const std::string one(unit == "-" ? "0" : "0 " + std::string(unit));
  const std::string expected = "three components like [" + one + ", " + one + ", " + one + "]";
  const auto& values = list(key, expected);
  if (values.size() != 3) refuse(key, expected);
  Vec3 result;
  for (int i = 0; i < 3; ++i)
    result[i] = read_quantity(*values[static_cast<std::size_t>(i)],
                              below(key) + "[" + std::to_string(i) + "]", unit, {});
  return result;
}

Vec3 YamlNode::vec3_or(const std::string& key, std::string_view unit, const Vec3& otherwise) const {
  return has(key) ? vec3(key, unit) : otherwise;
}

std::vector<double> YamlNode::quantities(const std::string& key, std::string_view unit, Range range) const {
  std::vector<double> result;
  for (const auto& value : list(key, "a list of quantities"))
    result.push_back(
        read_quantity(*value, below(key) + "[" + std::to_string(result.size()) + "]", unit, range));
  return result;
}

std::vector<std::string> YamlNode::texts(const std::string& key) const {
  std::vector<std::string> result;
  for (const auto& value : list(key, "a list of texts")) {
    if (value->kind != Value::Kind::scalar)
      fail(*value, below(key) + "[" + std::to_string(result.size()) + "]", "a text");
    result.push_back(value->scalar);
  }
  return result;
}

YamlNode YamlNode::map(const std::string& key) const {
  Value& value = require(key, "a map");
  if (value.kind != Value::Kind::map) fail(value, below(key), "a map");
  return YamlNode(document_, &value, below(key));
}

std::vector<YamlNode> YamlNode::items(const std::string& key) const {
  std::vector<YamlNode> result;
  for (const auto& value : list(key, "a list of maps")) {
    const std::string path = below(key) + "[" + std::to_string(result.size()) + "]";
    if (value->kind != Value::Kind::map) fail(*value, path, "a map");
    result.push_back(YamlNode(document_, value.get(), path));
  }
  return result;
}

std::vector<YamlNode> YamlNode::items_or_none(const std::string& key) const {
  return has(key) ? items(key) : std::vector<YamlNode>{};
}

std::vector<std::string> YamlNode::keys() const {
  return value_->keys;
}

namespace {

template <class Value>
const Value* first_unused(const Value& value, const std::string& path, std::string& unused_path, const Value*& map) {
  for (std::size_t i = 0; i < value.children.size(); ++i) {
    const Value& child = *value.children[i];
    const bool is_map = value.kind == Value::Kind::map;
    const std::string child_path = is_map ? (path.empty() ? value.keys[i] : path + "." + value.keys[i])
                                          : path + "[" + std::to_string(i) + "]";
    if (is_map && !value.used[i]) {
      unused_path = child_path;
      map = &value;
      return &child;
    }
    const bool look_below =
        child.kind == Value::Kind::list || (child.kind == Value::Kind::map && child.opened);
    if (!look_below) continue;
    if (const Value* found = first_unused(child, child_path, unused_path, map)) return found;
  }
  return nullptr;
}

}  // namespace

std::vector<std::string> YamlNode::scalars(const std::string& key) const {
  std::vector<std::string> result;
  const auto collect = [&](const auto& self, const Value& value) -> void {
    if (value.kind == Value::Kind::scalar) result.push_back(value.scalar);
    for (const auto& child : value.children) self(self, *child);
  };
  collect(collect, require(key, "a value"));
  return result;
}

void YamlNode::finish() const {
  std::string unused_path;
  const Value* map = nullptr;
  const Value* unused = first_unused(*value_, path_, unused_path, map);
  if (unused == nullptr) return;
  std::string known;
  for (const std::string& key : map->asked) known += (known.empty() ? ", only: " : ", ") + key;
  throw InputError(document_->file + ":" + std::to_string(unused->line), unused_path, unused->described(), "no such field here" + known);
}

}  // namespace filum
