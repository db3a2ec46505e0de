#pragma once
// The trainer behind the browser: carries out what the browser in control asks for, one session or replay at a time, and
// records every session in the store. Commands wait in a queue and are carried out by the thread that calls run(); only the
// pointer's poses go straight to the device.

#include <array>
#include <atomic>
#include <condition_variable>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "cli/knot_pull.h"
#include "cli/live_session.h"
#include "cli/rating_desk.h"
#include "cli/replay_session.h"
#include "cli/session_files.h"
#include "cli/tool_stream.h"
#include "cli/trainer_lab.h"
#include "cli/wall_colours.h"
#include "server/server.h"
#include "session/store.h"

namespace filum {

struct TrainerOptions {
  std::string root;
  std::string serial_port;        // empty: no forceps
  std::string calibration;        // of the forceps, empty: as built
  std::string model_file;         // of filum reconcile, empty: the scenes' own
  std::string address = "127.0.0.1";
  std::uint16_t port = 8137;
  std::string viewer_folder;
  std::string store_folder;
  std::string datasets;           // of reconcile, empty: store_folder/datasets
  std::string hands;              // "haptic:PORT+igtl:PORT...", devices beside or instead of the forceps; empty: none
  double motion_scale = 1.0;      // of these
  int igtl_out = 0;               // port for the tools' poses, 0: none
  std::string camera;             // video for the calibration of a camera instead of a camera
};

class Trainer final : public ServerHost {
 public:
  /// Opens the store and the port. A store that cannot be written is told and warned of on every page, training goes on.
  explicit Trainer(TrainerOptions options);
  ~Trainer() override;

  std::string url() const { return server_->url(); }
  const std::string& store_warning() const { return store_warning_; }

  /// Serves until `quit` becomes true; looks at it ten times a second.
  void run(const std::atomic<bool>& quit);

  // ServerHost, called by the server's thread.
  void command(const ClientMessage& message) override;
  void controlled(bool by_somebody) override;
  std::optional<std::string> api(std::string_view path) override;
  std::optional<std::string> post(std::string_view path, const std::string& body) override;
  std::optional<std::string> put(std::string_view path, const std::string& body) override { return lab_.put(path, body); }
  std::optional<Document> document(std::string_view path) override;

 private:
  void open_store();
  std::optional<std::string> recording_of(const std::string& session);
  std::optional<std::string> result_of(const std::string& session);
  Conditions conditions_of(const std::string& session);
  void carry_out(const ClientMessage& message);
  void rest();
  void look_after();
  void start_task(const StartMessage& start);
  void start_session(const StartMessage& start, Setup setup, InputDevices inputs);
  void begin_recording(const StartMessage& start, const Setup& setup, const InputDevices& inputs);
  void end_session();
  void watch_pull();
  void finish_pull();
  void open_replay(const std::string& session);
  void stop_all();
  void choose_overlay(const std::string& kind);
  void push(const PointerMessage& message);
  void set_pointer(LiveSession* session);
  void warn_of_recording();
  void publish_state(const std::string& state);

  TrainerOptions options_;
  std::mutex store_mutex_;              // the store is used by the server's thread and by run()'s
  std::optional<Store> store_;
  std::string store_warning_;
  std::optional<RatingDesk> desk_;      // used by the server's thread only; none without a store
  std::map<std::string, Conditions> conditions_;  // by session, as its recording says; guarded by store_mutex_
  std::map<std::string, std::string> titles_;  // by task; constant
  TrainerLab lab_;
  std::unique_ptr<Server> server_;
  TrainerView view_;                    // of run()'s thread

  std::unique_ptr<ToolStream> stream_;  // may be absent
  std::unique_ptr<Recorder> recorder_;
  std::unique_ptr<LiveSession> session_;
  std::unique_ptr<ReplaySession> replay_;
  std::shared_ptr<WallColours> colours_;  // of the session or replay that is shown
  std::unique_ptr<KnotPull> pull_;      // of the last session that ended

  std::mutex pointer_mutex_;
  PointerDevice* pointer_ = nullptr;    // guarded by pointer_mutex_, as the two below
  std::array<double, 3> widest_{};      // [rad], opening of each tool
  bool somebody_in_control_ = false;

  std::mutex commands_mutex_;
  std::condition_variable commands_changed_;
  std::deque<ClientMessage> commands_;
};

/// Opening that a grip of 0 (open) to 1 (squeezed) commands [rad]: closed at kClosedGrip, beyond that the jaws squeeze.
double grip_angle_of(double grip, double widest) noexcept;
inline constexpr double kClosedGrip = 0.6;

/// Everything of a live session that a frame shows besides the observation.
TaskView task_view_of(const TaskStatus& status);
std::vector<DeviceView> device_views_of(const HapticReport& hands, const std::vector<std::string>& names);

}  // namespace filum
