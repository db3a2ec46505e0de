#include "cli/trainer.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>

#include "base/error.h"
#include "cli/options.h"
#include "cli/session_files.h"
#include "cli/trainer_check.h"
#include "training/needle_task.h"
#include "training/stitch_guide.h"

namespace filum {
namespace {

constexpr double kHardestSqueeze = 0.25;  // [rad] beyond closure: 3 N with the instruments' grip stiffness
constexpr std::size_t kMostCommands = 256;

HelloView hello_of(const TrainerOptions& options) {
  std::vector<std::string> problems;
  HelloView hello;
  hello.version = version();
  bool any_shown = false;
  for (const Chapter& chapter : load_chapters(options.root, problems)) {
    for (const Task& task : load_tasks(options.root, chapter, problems)) {
      const bool shown = std::filesystem::exists(demonstration_file(options.root, task.name));
      any_shown = any_shown || shown;
      if (task.demonstration_only && !shown) continue;  // there is nothing to do in it
      hello.tasks.push_back({task.name, task.title, task.description, chapter.title, task.demonstration_only, task.retraction != nullptr, shown, task.needle && !task.needle->scales.empty()});
    }
  }
  for (const std::string& problem : problems) std::fprintf(stderr, "filum: left out: %s\n", problem.c_str());
  hello.inputs = {"pointer"};
  if (any_shown) hello.inputs.emplace_back("demo");
  if (!options.serial_port.empty() || !options.hands.empty()) hello.inputs.emplace_back("device");
  if (!options.hands.empty()) hello.devices.push_back({options.hands, "waiting", 0, 0, 0, 0});
  if (!options.serial_port.empty()) hello.devices.push_back({"serial " + options.serial_port, "waiting", 0, 0, 0, 0});
  return hello;
}

}  // namespace

double grip_angle_of(double grip, double widest) noexcept {
  if (grip < kClosedGrip) return widest * (1.0 - grip / kClosedGrip);
  return -kHardestSqueeze * (grip - kClosedGrip) / (1.0 - kClosedGrip);
}

TaskView task_view_of(const TaskStatus& s) {
  TaskView view{s.step_name, s.step_index, s.steps, s.hint, s.elapsed, s.done, {}, {}, s.within, {}};
  view.target.assign(s.target.data(), s.target.data() + s.target.size());
  for (const TaskWarning& w : s.warnings) view.warnings.push_back({w.level, w.text, w.code});
  if (!s.retraction) return view;
  const PressureWatch& p = *s.retraction;
  const PressureLimits& l = p.limits();
  RetractionView& r = view.retraction;
  r.present = true;
  r.blind = s.blind;
  r.pressure = p.pressure() / kMmHg;
  r.alarm = l.alarm / kMmHg;
  r.dose = p.dose() / (60.0 * kMmHg);
  r.loaded = p.loaded();
  r.perfusion = l.perfusion ? p.perfusion() / kMmHg : -1.0;
  r.band = name_of(p.band());
  r.dose_band = name_of(p.dose_band());
  for (std::size_t k = 0; k < 3; ++k) {
    r.bands[k] = l.bands[k] / kMmHg;
    r.dose_bands[k] = l.dose_bands[k] / (60.0 * kMmHg);
  }
  r.label = l.label;
  r.version = l.version;
  r.source = l.source;
  return view;
}

std::vector<DeviceView> device_views_of(const HapticReport& hands, const std::vector<std::string>& names) {
  std::vector<DeviceView> views;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const DeviceHealth& h = hands.devices[i];
    views.push_back({names[i], name_of(h.state), h.received, h.lost, h.corrupt, h.rejected});
  }
  return views;
}

Trainer::Trainer(TrainerOptions options)
    : options_(std::move(options)),
      lab_({options_.root, options_.datasets.empty() ? options_.store_folder + "/datasets" : options_.datasets, options_.store_folder, options_.serial_port, options_.calibration, options_.camera, camera_program()},
           [this](const std::string& session) { return recording_of(session); }) {
  check_trainer_options(options_);
  if (options_.igtl_out > 0) stream_ = std::make_unique<ToolStream>(options_.igtl_out);
  ServerOptions server;
  server.address = options_.address;
  server.port = options_.port;
  server.viewer_folder = options_.viewer_folder;
  server.hello = hello_of(options_);
  for (const TaskInfoView& task : server.hello.tasks) titles_[task.name] = task.title;
  server_ = std::make_unique<Server>(std::move(server), *this);
  open_store();
  publish_state("idle");
  server_->start();
}

Trainer::~Trainer() {
  stop_all();
  if (pull_) pull_->abandon();
  finish_pull();
  server_->stop();
}

void Trainer::open_store() {
  try {
    store_.emplace(options_.store_folder);
    desk_.emplace(options_.store_folder, [this](const std::string& session) { return result_of(session); });
    if (!desk_->trouble().empty()) store_warning_ = "Ratings are NOT being stored: " + desk_->trouble();
  } catch (const StoreError& error) {
    if (error.trouble == StoreTrouble::kNewer) throw;  // the right program is there to be used: nothing is to be stored beside it
    store_warning_ = std::string("Sessions are NOT being stored: ") + error.what();
  }
  view_.warning = store_warning_;
}

std::optional<std::string> Trainer::recording_of(const std::string& session) {
  const std::lock_guard lock(store_mutex_);
  const auto entry = store_ ? store_->find(session) : std::nullopt;
  if (!entry) return std::nullopt;
  return store_->file_of(entry->id);
}

void Trainer::publish_state(const std::string& state) {
  view_.state = state;
  server_->publish_trainer(view_);
}

// ---- server's thread

void Trainer::command(const ClientMessage& message) {
  if (const auto* pointer = std::get_if<PointerMessage>(&message)) return push(*pointer);
  const std::lock_guard lock(commands_mutex_);
  if (commands_.size() >= kMostCommands) return;
  commands_.push_back(message);
  commands_changed_.notify_one();
}

void Trainer::controlled(bool by_somebody) {
  const std::lock_guard lock(pointer_mutex_);
  somebody_in_control_ = by_somebody;
  if (pointer_ == nullptr) return;
  by_somebody ? pointer_->connected() : pointer_->disconnected();
}

void Trainer::push(const PointerMessage& m) {
  const std::lock_guard lock(pointer_mutex_);
  if (pointer_ == nullptr) return;
  DeviceSample sample;
  sample.tool = m.tool;
  sample.device_time_us = static_cast<std::int64_t>(m.time * 1e6);
  sample.has_pose = sample.has_grip_angle = true;
  sample.X_WD = m.X_WD;
  sample.grip_angle = grip_angle_of(m.grip, widest_[static_cast<std::size_t>(m.tool)]);
  sample.buttons = m.buttons;
  pointer_->push(sample);  // what it refuses it counts, and the page shows it
}

void Trainer::set_pointer(LiveSession* session) {
  const std::lock_guard lock(pointer_mutex_);
  pointer_ = session == nullptr ? nullptr : session->pointer();
  if (pointer_ == nullptr) return;
  for (std::size_t i = 0; i < widest_.size(); ++i) widest_[i] = session->scene().tools[i].max_angle;
  somebody_in_control_ ? pointer_->connected() : pointer_->disconnected();
}

// ---- thread of run()

void Trainer::run(const std::atomic<bool>& quit) {
  while (!quit.load()) {
    std::optional<ClientMessage> next;
    {
      std::unique_lock lock(commands_mutex_);
      commands_changed_.wait_for(lock, std::chrono::milliseconds(100), [this] { return !commands_.empty(); });
      if (!commands_.empty()) {
        next = std::move(commands_.front());
        commands_.pop_front();
      }
    }
    look_after();
    if (next) carry_out(*next);
  }
  stop_all();
}

void Trainer::look_after() {
  if (session_ && session_->over()) end_session();
  if (session_) warn_of_recording();
  if (pull_) watch_pull();
}

void Trainer::warn_of_recording() {
  if (!recorder_) return;
  const RecorderStatus status = recorder_->status();
  const std::string warning = status.healthy ? store_warning_ : "The recording is in trouble: " + status.message;
  if (warning == view_.warning) return;
  view_.warning = warning;
  publish_state(view_.state);
}

void Trainer::carry_out(const ClientMessage& message) {
  try {
    if (const auto* start = std::get_if<StartMessage>(&message)) start_task(*start);
    if (std::holds_alternative<StopMessage>(message)) stop_all();
    if (const auto* open = std::get_if<ReplayOpenMessage>(&message)) open_replay(open->session);
    if (const auto* overlay = std::get_if<OverlayMessage>(&message)) choose_overlay(overlay->kind);
    if (!replay_) return;
    if (std::holds_alternative<PlayMessage>(message)) replay_->play(true);
    if (std::holds_alternative<PauseMessage>(message)) replay_->play(false);
    if (const auto* seek = std::get_if<SeekMessage>(&message)) replay_->seek(seek->time);
  } catch (const InputError& error) {
    server_->publish_error({"bad-input", error.file + ": " + error.field + ": found " + error.value + ".", "Expected " + error.expected + "."});
    rest();
  } catch (const std::exception& error) {
    server_->publish_error({"failed", error.what(), "Nothing recorded is lost. Try again; filum doctor tells more."});
    rest();
  }
}

/// After a refusal: what did not begin holds nothing.
void Trainer::rest() {
  if (session_) return;
  lab_.port_in_use(false);
  if (!replay_) publish_state("idle");
}

/// An exam shows the tissue as it is.
void Trainer::choose_overlay(const std::string& kind) {
  if (view_.exam && kind != "none") throw InputError("overlay", "kind", kind, "none while an exam runs");
  if (colours_) colours_->choose(kind);
  if (replay_) replay_->show_again();
}

void Trainer::stop_all() {
  if (session_) {
    session_->request_stop();
    end_session();
  }
  view_.exam = false;
  if (replay_) {
    replay_.reset();
    view_.warning = store_warning_;
    publish_state("idle");
  }
}

void Trainer::start_task(const StartMessage& start) {
  stop_all();
  view_.task = start.task;
  view_.input = start.input;
  view_.recording = false;
  view_.exam = start.exam;
  view_.session.clear();
  publish_state("loading");
  Setup setup = load_setup(options_.root, start.task, options_.model_file, start.stiffness);
  LiveDevices devices;
  if (start.input == "device") devices = {options_.serial_port, lab_.calibration(), options_.hands, options_.motion_scale};
  if (start.input == "device" && !devices.any()) throw InputError("start", "input", "device", "a trainer started with --serial PATH or --hands");
  const bool serial = !devices.serial_port.empty();
  if (serial && lab_.calibrating()) throw InputError("start", "input", "device", "to end the calibration first: it uses the forceps");
  lab_.port_in_use(serial);
  InputDevices inputs = start.input == "demo" ? open_inputs("demo", options_.root, start.task) : open_live_inputs(devices, options_.root);
  start_session(start, std::move(setup), std::move(inputs));
}

void Trainer::begin_recording(const StartMessage& start, const Setup& setup, const InputDevices& inputs) {
  recorder_.reset();
  view_.warning = store_warning_;
  if (!store_) return;
  try {
    const std::lock_guard lock(store_mutex_);
    const StoreEntry entry = store_->begin(start.task, start.code);
    recorder_ = make_recorder(store_->file_of(entry.id), setup, inputs.description, start.code, inputs.calibration);
    view_.session = entry.id;
    view_.recording = true;
  } catch (const std::exception& error) {
    view_.session.clear();
    view_.warning = std::string("This session is NOT being stored: ") + error.what();
  }
}

void Trainer::start_session(const StartMessage& start, Setup setup, InputDevices inputs) {
  begin_recording(start, setup, inputs);
  LiveOptions options;
  options.recorder = recorder_.get();
  if (recorder_ && start.exam) recorder_->record_event({0, 0.0, "exam", -1, 1.0, "-"});
  colours_ = std::make_shared<WallColours>(setup.model);
  const auto marks = setup.task.needle ? eye_marks(setup.task.needle->goals, setup.model->description.tissue) : std::vector<StitchGuide>();
  const auto guides = !marks.empty() ? marks : start.exam || !setup.task.needle ? std::vector<StitchGuide>() : stitch_guides(setup.model->description.tissue, setup.model->description.needle, *setup.task.needle);
  options.show = [server = server_.get(), stream = stream_.get(), colours = colours_](const LiveView& v) {
    if (stream) stream->send_all(v.observation);
    TaskView task = task_view_of(v.status);
    for (const TaskWarning& w : v.handle_warnings) task.warnings.push_back({w.level, w.text, w.code});
    server->publish_frame(frame_body(v.observation, &task, device_views_of(v.hands, v.device_names), colours->view(v.observation)),
                          v.observation.real_time_factor, v.observation.overruns);
  };
  options.show_event = [server = server_.get()](const TaskEvent& e) {
    server->publish_event({e.time, e.name, e.tool, e.value, e.unit, e.text});
  };
  session_ = std::make_unique<LiveSession>(std::move(setup), std::move(inputs), std::move(options));
  server_->publish_scene(session_->scene(), guides);
  session_->start();
  set_pointer(session_.get());
  view_.pointer = session_->pointer() != nullptr;
  publish_state("running");
}

/// Shows the result at once; what the pull test of its knot says comes later, while the trainee may go on.
void Trainer::end_session() {
  set_pointer(nullptr);
  view_.pointer = false;
  finish_pull();
  lab_.port_in_use(false);
  view_.recording = false;
  Result result;
  try {
    result = session_->end().result;
  } catch (const std::exception& error) {
    session_.reset();
    recorder_.reset();
    server_->publish_error({"failed", std::string("Scoring failed: ") + error.what(), "The recording holds what happened."});
    return publish_state("ended");
  }
  const bool to_pull = session_->knot_to_pull();
  view_.knot_test = to_pull ? 0.0 : -1.0;
  pull_ = std::make_unique<KnotPull>(std::move(session_), std::move(recorder_), view_.session);
  if (to_pull) {
    server_->publish_result(result_message(result, view_.session));
  } else {
    finish_pull();
  }
  publish_state("ended");
}

/// Tells how far the pull test is, and its end.
void Trainer::watch_pull() {
  if (pull_->over()) {
    finish_pull();
    publish_state(view_.state);
  } else if (pull_->progress() > view_.knot_test + 0.02) {
    view_.knot_test = pull_->progress();
    publish_state(view_.state);
  }
}

/// Waits for the pull test and enters the score. Its result is shown unless another session has begun since.
void Trainer::finish_pull() {
  if (!pull_) return;
  const std::unique_ptr<KnotPull> pull = std::move(pull_);
  view_.knot_test = -1.0;
  Result r;
  try {
    r = pull->finish();
  } catch (const std::exception& error) {
    server_->publish_error({"failed", std::string("The pull test failed: ") + error.what(), "filum score does it again."});
    return;
  }
  if (const Recorder* recorder = pull->recorder()) {
    const RecorderStatus status = recorder->status();
    if (!status.healthy) view_.warning = "The recording is incomplete: " + status.message;
    try {
      const std::lock_guard lock(store_mutex_);
      store_->finish(pull->id(), ScoreRecord{r.passed, r.total, r.seconds, ""});
    } catch (const std::exception& error) {
      const std::string also = status.healthy ? "The session is stored, but" : view_.warning + (view_.warning.ends_with('.') ? " It is" : ". It is");
      view_.warning = also + " not entered in the index: " + error.what();
    }
  }
  if (!session_ && !replay_ && view_.session == pull->id()) server_->publish_result(result_message(r, pull->id()));
}

void Trainer::open_replay(const std::string& session) {
  stop_all();
  std::string file;
  {
    const std::lock_guard lock(store_mutex_);
    const auto entry = store_ ? store_->find(session) : std::nullopt;
    if (!entry) throw InputError("store", "session", session, "the identifier of a stored session");
    file = store_->file_of(entry->id);
    view_.task = entry->task;
  }
  view_.input.clear();
  view_.session = session;
  publish_state("loading");
  replay_ = std::make_unique<ReplaySession>(
      file, session,
      [server = server_.get(), this](const Observation& o, const TaskView& task) {
        server->publish_frame(frame_body(o, &task, {}, colours_->view(o)), 1.0, 0);
      },
      [server = server_.get()](const ReplayView& replay) { server->publish_replay(replay); });
  colours_ = std::make_shared<WallColours>(replay_->model());
  server_->publish_scene(replay_->scene());
  const std::string damage = replay_->damage();
  if (!damage.empty()) view_.warning = damage;
  const std::string result = result_message(replay_->stored_score(), session);
  if (!result.empty()) server_->publish_result(result);
  publish_state("replay");
  replay_->start();
}

}  // namespace filum
