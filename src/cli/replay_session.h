#pragma once
// A recording in the viewer: stepped anew in the background at full speed, kept as pictures, shown with play, pause and seek.

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "cli/session_files.h"
#include "server/views.h"
#include "training/task_session.h"

namespace filum {

class ReplaySession {
 public:
  using ShowFrame = std::function<void(const Observation&, const TaskView&)>;
  using ShowState = std::function<void(const ReplayView&)>;

  /// Throws InputError if the recording cannot be read. The callbacks are called by a thread of this object.
  ReplaySession(const std::string& file, std::string session, ShowFrame show_frame, ShowState show_state);
  ~ReplaySession();

  const SceneDescription& scene() const { return world_.description(); }
  std::shared_ptr<const Model> model() const { return recorded_.setup().model; }
  /// Score as stored in the recording, JSON text; empty if there is none.
  const std::string& stored_score() const { return stored_score_; }
  /// What is wrong with the recording, in one sentence; empty: nothing. What can be read is shown.
  std::string damage() const;

  // Any thread.
  void start();
  void play(bool on);
  void seek(double time);  // [s]
  void show_again();       // the picture that is shown, for another overlay

 private:
  struct Picture {
    Observation observation;
    TaskView task;
  };
  void load();
  void end_here();
  void keep_picture(const Observation& observation);
  void show_loop();
  double ready_to() const;  // [s], under mutex_
  bool show_next(double elapsed);

  std::string session_;
  RecordingReader recording_;
  RecordedSetup recorded_;
  World world_;
  std::string stored_score_;
  ShowFrame show_frame_;
  ShowState show_state_;
  double duration_ = 0.0;          // [s]
  double interval_ = 1.0 / 30.0;   // [s], between pictures
  TaskSession task_;               // of the loading thread

  std::mutex mutex_;
  std::vector<Picture> pictures_;  // guarded by mutex_, as those below
  double time_ = 0.0;              // [s], shown
  bool playing_ = false;
  bool changed_ = true;            // state to be told
  std::size_t shown_ = static_cast<std::size_t>(-1);

  std::atomic<bool> quit_{false};
  std::thread loader_, shower_;
};

}  // namespace filum
