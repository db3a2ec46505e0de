#include "server/encode.h"

#include "server/encode_brain.h"
#include "server/encode_needle.h"
#include "server/vector_json.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

namespace filum {
namespace {

using nlohmann::json;

// Text from outside (a device's name, a file's) may hold bytes that are not UTF-8: replaced, never thrown over.
std::string text_of(const json& value) { return value.dump(-1, ' ', false, json::error_handler_t::replace); }

json optional_text(const std::string& text) { return text.empty() ? json(nullptr) : json(text); }

json task_info_json(const TaskInfoView& task) {
  return {{"name", task.name},
          {"title", task.title},
          {"summary", task.summary},
          {"chapter", task.chapter},
          {"demonstration", task.demonstration},
          {"picture", task.name},
          {"dial", task.dial},
          {"shown", task.shown},
          {"rated", task.rated}};
}

json device_json(const DeviceView& d) {
  return {{"name", d.name}, {"state", d.state},     {"received", d.received},
          {"lost", d.lost}, {"corrupt", d.corrupt}, {"rejected", d.rejected}};
}

json task_json(const TaskView& task) {
  json warnings = json::array();
  for (const WarningView& w : task.warnings) warnings.push_back({{"level", w.level}, {"text", w.text}, {"code", w.code}});
  return {{"step_name", task.step_name}, {"step_index", task.step_index}, {"steps", task.steps},
          {"hint", task.hint},           {"elapsed", task.elapsed},       {"done", task.done},
          {"warnings", warnings},       {"retraction", retraction_json(task.retraction)},        {"target", task.target},         {"within", task.within}};
}

template <class Items, class Function>
json list_json(const Items& items, Function to_json) {
  json list = json::array();
  for (const auto& item : items) list.push_back(to_json(item));
  return list;
}

// Frames are written by hand: 60 a second with a few thousand numbers each.
class FrameWriter {
 public:
  FrameWriter() { out_.reserve(16 * 1024); }

  FrameWriter& raw(std::string_view text) {
    out_.append(text);
    return *this;
  }
  // 8 digits: a position of 50 mm is then told to 1 nm.
  FrameWriter& number(double x) {
    char buffer[32];
    const auto end = std::to_chars(buffer, buffer + sizeof buffer, std::isfinite(x) ? x : 0.0, std::chars_format::general, 8);
    out_.append(buffer, end.ptr);
    return *this;
  }
  FrameWriter& whole(long long x) {
    char buffer[32];
    const auto end = std::to_chars(buffer, buffer + sizeof buffer, x);
    out_.append(buffer, end.ptr);
    return *this;
  }
  FrameWriter& flag(bool x) { return raw(x ? "true" : "false"); }
  FrameWriter& numbers(const double* x, int n) {
    out_.push_back('[');
    for (int i = 0; i < n; ++i) {
      if (i > 0) out_.push_back(',');
      number(x[i]);
    }
    out_.push_back(']');
    return *this;
  }
  FrameWriter& pose(const Pose& X) {
    const double wxyz[4] = {X.q.w(), X.q.x(), X.q.y(), X.q.z()};
    return raw("{\"position\":").numbers(X.p.data(), 3).raw(",\"quaternion\":").numbers(wxyz, 4).raw("}");
  }
  std::string take() { return std::move(out_); }

 private:
  std::string out_;
};

void write_tool(FrameWriter& w, const ToolObservation& tool) {
  w.raw("{\"pose\":").pose(tool.X_WT).raw(",\"device_pose\":").pose(tool.X_WD);
  w.raw(",\"grip_angle\":").number(tool.grip_angle).raw(",\"grip_force\":").number(tool.grip_force);
  w.raw(",\"thread_force\":").number(tool.thread_force).raw(",\"force\":").numbers(tool.f_T_W.data(), 3);
  w.raw(",\"grasped\":").whole(tool.grasped_edge).raw(",\"input_valid\":").flag(tool.input_valid).raw("}");
}

void write_cuts(FrameWriter& w, const Observation& o) {
  w.raw(",\"cuts\":[");
  bool first = true;
  for (int k = 0; k < o.n_parted; ++k) {
    const int edge = o.parted[static_cast<std::size_t>(k)];
    if (edge == o.break_edge) continue;
    if (!first) w.raw(",");
    w.whole(edge);
    first = false;
  }
  w.raw("]");
}

/// x y z and 1 if broken, of each.
void write_objects(FrameWriter& w, const Observation& o) {
  std::array<double, 4 * kMaxPellets> row{};
  const int n = std::clamp(o.n_pellets, 0, kMaxPellets);
  for (int k = 0; k < n; ++k) {
    const PelletObservation& p = o.pellets[static_cast<std::size_t>(k)];
    for (int i = 0; i < 3; ++i) row[static_cast<std::size_t>(4 * k + i)] = p.p_W[i];
    row[static_cast<std::size_t>(4 * k + 3)] = p.broken ? 1.0 : 0.0;
  }
  w.raw(",\"objects\":").numbers(row.data(), 4 * n);
}

json post_json(const PostShape& post) {
  return {{"position", vector_json(post.p_W)},
          {"axis", vector_json(post.axis_W)},
          {"radius", post.radius},
          {"half_length", post.half_length}};
}

}  // namespace

std::string hello_message(const HelloView& hello, int client) {
  return text_of({{"type", "hello"},
                  {"program", "filum"},
                  {"version", hello.version},
                  {"protocol", kProtocol},
                  {"client", client},
                  {"tasks", list_json(hello.tasks, task_info_json)},
                  {"devices", list_json(hello.devices, device_json)},
                  {"inputs", hello.inputs}});
}

std::string scene_message(const SceneDescription& scene, const std::vector<StitchGuide>& guides) {
  json tools = json::array();
  for (int i = 0; i < std::min(scene.n_tools, static_cast<int>(scene.tools.size())); ++i) {
    const ToolShape& t = scene.tools[static_cast<std::size_t>(i)];
    tools.push_back({{"name", t.name},
                     {"kind", t.kind},
                     {"jaw_length", t.jaw_length},
                     {"tip_radius", t.tip_radius},
                     {"base_radius", t.base_radius},
                     {"pad_length", t.pad_length},
                     {"max_angle", t.max_angle}});
  }
  json objects = json::array();
  for (int i = 0; i < scene.n_pellets; ++i) {
    const PelletShape& p = scene.pellets[static_cast<std::size_t>(i)];
    objects.push_back({{"name", p.name}, {"radius", p.radius}});
  }
  return text_of({{"type", "scene"},
                  {"task", scene.task},
                  {"title", scene.title},
                  {"suture", scene.suture},
                  {"thread_radius", scene.thread_radius},
                  {"thread_strength", scene.thread_strength},
                  {"dt", scene.dt},
                  {"post", scene.has_post ? post_json(scene.post) : json()},
                  {"base", scene.has_post ? post_json(scene.base) : json()},
                  {"notch", list_json(scene.notch, post_json)},
                  {"frame", list_json(scene.frame, post_json)},
                  {"floor_height", scene.floor_height},
                  {"tools", tools},
                  {"objects", objects},
                  {"field", scene.has_field ? vector_json(scene.field_W) : json()},
                  {"brain", brain_scene_json(scene.brain, scene.n_tools)},
                  {"needle", needle_scene_json(scene.needle)},
                  {"tissue", tissue_scene_json(scene.tissue)},
                  {"guides", list_json(guides, guide_json)},
                  {"capacity", scene.capacity}});
}

std::string event_message(const EventView& e) {
  return text_of({{"type", "event"},
                  {"event",
                   {{"time", e.time}, {"name", e.name}, {"tool", e.tool}, {"value", e.value}, {"unit", e.unit}, {"text", e.text}}}});
}

std::string session_state_message(const TrainerView& trainer, int controller, bool in_control, int clients) {
  return text_of({{"type", "session_state"},
                  {"state", trainer.state},
                  {"task", trainer.task},
                  {"input", optional_text(trainer.input)},
                  {"pointer", trainer.pointer},
                  {"controller", controller},
                  {"in_control", in_control},
                  {"clients", clients},
                  {"recording", trainer.recording},
                  {"exam", trainer.exam},
                  {"session", optional_text(trainer.session)},
                  {"warning", trainer.warning},
                  {"knot_test", trainer.knot_test < 0.0 ? json(nullptr) : json(trainer.knot_test)}});
}

std::string replay_state_message(const ReplayView& replay) {
  return text_of({{"type", "replay_state"},
                  {"session", replay.session},
                  {"time", replay.time},
                  {"duration", replay.duration},
                  {"ready", replay.ready},
                  {"playing", replay.playing}});
}

std::string error_message(const Refusal& refusal) {
  return text_of({{"type", "error"}, {"code", refusal.code}, {"what", refusal.what}, {"advice", refusal.advice}});
}

std::string frame_body(const Observation& o, const TaskView* task, const std::vector<DeviceView>& devices, const OverlayView& overlay) {
  const int nodes = std::min(o.n_nodes, static_cast<int>(o.positions.cols()));
  const int edges = std::clamp(nodes - 1, 0, static_cast<int>(o.tension.size()));
  FrameWriter w;
  w.raw(",\"step\":").whole(static_cast<long long>(o.step)).raw(",\"time\":").number(o.time);
  w.raw(",\"positions\":").numbers(o.positions.data(), 3 * nodes);
  w.raw(",\"tension\":").numbers(o.tension.data(), edges);
  w.raw(",\"contact\":").numbers(o.contact.data(), std::min(nodes, static_cast<int>(o.contact.size())));
  w.raw(",\"tools\":[");
  for (int i = 0; i < std::min(o.n_tools, static_cast<int>(o.tools.size())); ++i) {
    if (i > 0) w.raw(",");
    write_tool(w, o.tools[static_cast<std::size_t>(i)]);
  }
  w.raw("],\"broken\":").flag(o.broken).raw(",\"break_edge\":").whole(o.break_edge);
  write_cuts(w, o);
  write_objects(w, o);
  w.raw(",\"brain\":").raw(brain_frame_text(o));
  w.raw(",\"needle\":").raw(needle_frame_text(o.needle)).raw(",\"tissue\":").raw(tissue_frame_text(o.tissue));
  w.raw(",\"overlay\":").raw(overlay_text(overlay));
  w.raw(",\"overruns\":").whole(static_cast<long long>(o.overruns)).raw(",\"real_time_factor\":").number(o.real_time_factor);
  w.raw(",\"task\":").raw(task == nullptr ? "null" : text_of(task_json(*task)));
  w.raw(",\"devices\":").raw(text_of(list_json(devices, device_json))).raw("}");
  return w.take();
}

std::string frame_message(unsigned long long id, const std::string& body) {
  return "{\"type\":\"frame\",\"id\":" + std::to_string(id) + body;
}

std::string task_list_json(const std::vector<TaskInfoView>& tasks) {
  return text_of({{"tasks", list_json(tasks, task_info_json)}});
}

std::string health_json(const std::string& version, const TrainerView& trainer, int clients, double real_time_factor,
                        std::uint64_t overruns) {
  return text_of({{"ok", true},
                  {"program", "filum"},
                  {"version", version},
                  {"protocol", kProtocol},
                  {"clients", clients},
                  {"state", trainer.state},
                  {"real_time_factor", real_time_factor},
                  {"overruns", overruns}});
}

}  // namespace filum
