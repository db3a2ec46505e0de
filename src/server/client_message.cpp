#include "server/client_message.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

namespace filum {
namespace {

constexpr std::uint32_t kButtons = 63;  // all that there are (devices/device.h); the bits above are a handle's faults

using nlohmann::json;

// Collects the first fault found while a message's fields are read; later reads then give harmless defaults.
class Fields {
 public:
  Fields(const json& message, std::string type) : message_(message), type_(std::move(type)) {}

  void only(std::initializer_list<const char*> allowed) {
    for (const auto& [key, value] : message_.items()) {
      if (key == "type") continue;
      if (std::none_of(allowed.begin(), allowed.end(), [&k = key](const char* a) { return k == a; })) {
        fault(key.substr(0, 40), "a field of this message");
      }
    }
  }

  double number(const char* name, double low, double high) {
    const json* value = find(name);
    if (value == nullptr) return 0.0;
    return checked_number(*value, name, low, high);
  }

  std::uint64_t count(const char* name, std::uint64_t high) {
    const json* value = find(name);
    if (value == nullptr) return 0;
    if (!value->is_number_unsigned() || value->get<std::uint64_t>() > high) {
      fault(name, "a whole number from 0 to " + std::to_string(high));
      return 0;
    }
    return value->get<std::uint64_t>();
  }

  std::string text(const char* name, std::size_t max_length) {
    const json* value = find(name);
    if (value == nullptr) return {};
    if (!value->is_string() || value->get_ref<const std::string&>().size() > max_length) {
      fault(name, "a text of at most " + std::to_string(max_length) + " bytes");
      return {};
    }
    return value->get<std::string>();
  }

  bool has(const char* name) const { return message_.contains(name); }

  bool flag(const char* name) {
    const json* value = find(name);
    if (value != nullptr && !value->is_boolean()) fault(name, "true or false");
    return value != nullptr && value->is_boolean() && value->get<bool>();
  }

  template <int n>
  Eigen::Matrix<double, n, 1> vector(const char* name, double limit) {
    Eigen::Matrix<double, n, 1> result = Eigen::Matrix<double, n, 1>::Zero();
    const json* value = find(name);
    if (value == nullptr) return result;
    if (!value->is_array() || value->size() != n) {
      fault(name, "an array of " + std::to_string(n) + " numbers");
      return result;
    }
    for (int i = 0; i < n; ++i) result[i] = checked_number((*value)[static_cast<std::size_t>(i)], name, -limit, limit);
    return result;
  }

  void fault(const std::string& name, const std::string& expected) {
    if (what_.empty()) what_ = type_ + ": " + name + ": expected " + expected;
  }
  const std::string& what() const { return what_; }

 private:
  const json* find(const char* name) {
    const auto at = message_.find(name);
    if (at != message_.end()) return &*at;
    fault(name, "to be present");
    return nullptr;
  }

  double checked_number(const json& value, const char* name, double low, double high) {
    const double x = value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN();
    if (std::isfinite(x) && x >= low && x <= high) return x;
    fault(name, "a finite number from " + json(low).dump() + " to " + json(high).dump());
    return 0.0;
  }

  const json& message_;
  std::string type_;
  std::string what_;
};

bool is_code_character(char c) {
  return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '_' || c == '-';
}

StartMessage read_start(Fields& fields) {
  fields.only({"task", "input", "code", "take_over", "stiffness", "exam"});
  StartMessage m{fields.text("task", 64), fields.text("input", 16), "", false, 1.0, false};
  if (m.input != "pointer" && m.input != "demo" && m.input != "device") fields.fault("input", "pointer, demo or device");
  if (fields.has("code")) m.code = fields.text("code", 32);
  if (!std::all_of(m.code.begin(), m.code.end(), is_code_character)) fields.fault("code", "letters, digits, - and _ only");
  if (fields.has("take_over")) m.take_over = fields.flag("take_over");
  if (fields.has("stiffness")) m.stiffness = fields.number("stiffness", 0.1, 10.0);
  if (fields.has("exam")) m.exam = fields.flag("exam");
  return m;
}

OverlayMessage read_overlay(Fields& fields) {
  fields.only({"kind"});
  OverlayMessage m{fields.text("kind", 16)};
  if (m.kind != "none" && m.kind != "strain" && m.kind != "pressure") fields.fault("kind", "none, strain or pressure");
  return m;
}

PointerMessage read_pointer(Fields& fields) {
  fields.only({"tool", "time", "position", "quaternion", "grip", "buttons"});
  PointerMessage m;
  m.tool = static_cast<int>(fields.count("tool", 2));
  m.time = fields.number("time", -1e12, 1e12);
  m.X_WD.p = fields.vector<3>("position", kReach);
  const Eigen::Vector4d wxyz = fields.vector<4>("quaternion", 2.0);
  if (wxyz.norm() < 0.5) {
    fields.fault("quaternion", "unit length");
  } else {
    m.X_WD.q = Quat(wxyz[0], wxyz[1], wxyz[2], wxyz[3]).normalized();
  }
  m.grip = fields.number("grip", 0.0, 1.0);
  m.buttons = static_cast<std::uint32_t>(fields.count("buttons", kButtons));
  return m;
}

ReplayOpenMessage read_replay_open(Fields& fields) {
  fields.only({"session"});
  ReplayOpenMessage m{fields.text("session", 128)};
  if (m.session.empty()) fields.fault("session", "an identifier");
  return m;
}

ClientMessage read(const std::string& type, Fields& fields) {
  if (type == "start") return read_start(fields);
  if (type == "pointer") return read_pointer(fields);
  if (type == "replay_open") return read_replay_open(fields);
  if (type == "overlay") return read_overlay(fields);
  if (type == "ack") {
    fields.only({"frame"});
    return AckMessage{fields.count("frame", std::numeric_limits<std::uint64_t>::max())};
  }
  if (type == "seek") {
    fields.only({"time"});
    return SeekMessage{fields.number("time", 0.0, 1e9)};
  }
  fields.only({});
  if (type == "stop") return StopMessage{};
  if (type == "take_control") return TakeControlMessage{};
  if (type == "play") return PlayMessage{};
  if (type == "pause") return PauseMessage{};
  fields.fault("type", "the name of a message");
  return StopMessage{};
}

Refusal bad_message(const std::string& what) {
  return {"bad-message", what, "Reload the page: the viewer and the trainer may be of different versions."};
}

}  // namespace

std::variant<ClientMessage, Refusal> parse_client_message(std::string_view text) {
  if (text.size() > kMaxClientMessage) return bad_message("message longer than " + std::to_string(kMaxClientMessage) + " bytes");
  const json message = json::parse(text, nullptr, false);
  if (!message.is_object()) return bad_message("not a JSON object");
  const auto type = message.find("type");
  if (type == message.end() || !type->is_string()) return bad_message("type: expected the name of a message");
  const std::string name = type->get<std::string>().substr(0, 40);
  Fields fields(message, name);
  ClientMessage result = read(name, fields);
  if (!fields.what().empty()) return bad_message(fields.what());
  return result;
}

}  // namespace filum
