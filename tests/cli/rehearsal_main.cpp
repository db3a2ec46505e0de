// Tries ends of a demonstration without its beginning: `filum_rehearsal ROOT TASK SCRIPT NAME UNTIL [T ...]` runs a script to UNTIL [s] and, at each T, leaves a sleeping
// copy of the whole process behind (fork) that listens at ./NAME_T (a pipe). `echo "go NAME SCRIPT UNTIL [T ...]" > FILE` wakes one: it goes on from there with another
// script whose keys before T are the same, bit for bit as `filum run` would from the start, and writes to NAME.out; `quit` ends it. What the hands have seen and felt so
// far is remembered and shown to the new script, which then stands where the old one stood. At each T and at UNTIL a line of JSON tells the stitches and knots there are;
// where the script has come to its end also the result that `filum run` would give.
// A tool for those who write demonstrations (sew_eight.py); nothing of the product or its tests needs it.

#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cinttypes>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <span>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/hash.h"
#include "cli/security.h"
#include "cli/setup.h"
#include "devices/demonstrator.h"
#include "haptics/haptic_loop.h"
#include "haptics/scene_eyes.h"
#include "training/cut_line.h"
#include "training/stitch_knot.h"
#include "training/task_session.h"
#include "world/state.h"
#include "world/world.h"

namespace filum {
namespace {

constexpr std::int64_t kTick = 1000;  // [us], of the hands

/// Eyes that remember all they told, and tell it again to hands that begin anew.
class Memory final : public Eyes {
 public:
  explicit Memory(const Eyes& eyes) : eyes_(eyes) {}
  bool find(const Look& look, Pose& X_WF) const noexcept override {
    if (next_ == told_.size()) {
      Told now;
      now.found = eyes_.find(look, now.X_WF);
      told_.push_back(now);
    }
    const Told& t = told_[next_++];
    if (t.found) X_WF = t.X_WF;
    return t.found;
  }
  double felt(int tool) const noexcept override {
    if (next_ == told_.size()) told_.push_back({false, {}, eyes_.felt(tool)});
    return told_[next_++].felt;
  }
  void from_the_start() noexcept { next_ = 0; }
  bool all_told() const noexcept { return next_ == told_.size(); }

 private:
  struct Told {
    bool found = false;
    Pose X_WF;
    double felt = 0.0;
  };
  const Eyes& eyes_;
  mutable std::vector<Told> told_;
  mutable std::size_t next_ = 0;
};

class Rehearsal {
 public:
  Rehearsal(const std::string& root, const std::string& task, const std::string& script, std::string name)
      : Rehearsal(load_setup(root, task), std::move(name)) {
    take_script(script);
  }

  void run(double until, const std::vector<double>& stops) {
    const double dt = world_.description().dt;
    std::size_t next = 0;
    while (world_.observation().time < until - 0.5 * dt && hands_->device(0).health().state != DeviceState::finished) {
      move_hands(static_cast<std::int64_t>((world_.observation().time + 0.5 * dt) * 1e6));
      world_.step(hands_->inputs().read());
      task_.observe(world_.observation());
      tell_events();
      for (; next < stops.size() && world_.observation().time >= stops[next] - 0.5 * dt; ++next) {
        tell("stop");
        stay_behind(stops[next]);
      }
    }
    tell("end");
    if (hands_->device(0).health().state == DeviceState::finished) tell_result();
  }

 private:
  Rehearsal(Setup setup, std::string name)
      : world_(setup.model), task_(std::move(setup.task), world_.description()), eyes_(world_.observation(), world_.description()), memory_(eyes_), name_(std::move(name)) {}

  void take_script(const std::string& file) {
    auto demonstrator = std::make_unique<Demonstrator>(file);
    demonstrator->look_through(&memory_);
    std::vector<std::unique_ptr<Device>> devices;
    devices.push_back(std::move(demonstrator));
    hands_ = std::make_unique<HapticLoop>(std::move(devices));
    memory_.from_the_start();
    const std::int64_t now = std::exchange(next_us_, 0);
    const std::uint64_t moved = std::exchange(moved_, 0);
    move_hands(now - kTick);
    if (!memory_.all_told() || moved_ != moved) throw InputError(file, "tools", "other keys before " + std::to_string(1e-6 * static_cast<double>(now)) + " s", "up to there those of the script before it");
  }
  void move_hands(std::int64_t until_us) noexcept {
    for (; next_us_ <= until_us; next_us_ += kTick) {
      hands_->tick(next_us_);
      for (const ToolInput& t : hands_->inputs().read().tools) moved_ = hash_of(t, moved_);
    }
  }
  static std::uint64_t hash_of(const ToolInput& t, std::uint64_t seed) noexcept {
    const auto& p = t.X_WD.p;
    const auto& q = t.X_WD.q.coeffs();
    const std::array<double, 10> moved{p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w(), t.grip_angle, t.valid ? 1.0 : 0.0, static_cast<double>(t.buttons)};
    return hash_array(std::span(moved), seed);
  }

  void tell_events() {
    for (; told_ < task_.events().size(); ++told_) {
      const TaskEvent& e = task_.events()[told_];
      if (std::strcmp(e.name, "solver-trouble") != 0) std::printf("%.3f %s %g\n", e.time, e.name, e.value);
    }
  }

  /// Lengths in mm, angles in degrees.
  void tell(const char* why) const {
    const Observation& o = world_.observation();
    char hash[17];
    std::snprintf(hash, sizeof hash, "%016" PRIx64, o.state_hash);
    nlohmann::ordered_json j = {{"why", why}, {"t", o.time}, {"hash", hash}, {"nodes", o.n_nodes}, {"needle_held", o.needle.held}};
    j["thread_held"] = {o.tools[0].grasped_edge >= 0, o.tools[1].grasped_edge >= 0};
    j["passes"] = j["knots"] = nlohmann::ordered_json::array();
    for (int k = 0; k < o.tissue.n_passes; ++k) {
      const PassObservation& p = o.tissue.passes[static_cast<std::size_t>(k)];
      j["passes"].push_back({{"state", static_cast<int>(p.state)}, {"out", p.out}, {"side", p.side}, {"bites", {1e3 * p.bite_entry, 1e3 * p.bite_exit}}, {"depths", {p.entry_depth, p.exit_depth}}, {"torn", p.torn > 0.0}});
    }
    for (const StitchKnot& k : knots_in_tissue(o)) j["knots"].push_back({{"class", k.knot.knot_class}, {"loop", 1e3 * k.loop()}, {"tail", 1e3 * k.tail}, {"short", 1e3 * k.short_tail}});
    if (const Result now = task_.finish(); now.needle && now.needle->has_tissue)
      for (const Stitch& k : now.needle->stitches) j["stitches"].push_back({{"knot", k.knot}, {"angle", round_cut_ * k.position}, {"slack", 1e3 * k.slack}});
    std::printf("%s\n", j.dump().c_str());
    std::fflush(stdout);
  }

  /// As `filum run` ends: [ml/min], and thicknesses of the wall.
  void tell_result() const {
    const Result r = finish_with_security(task_, world_, [](double) { return true; });
    nlohmann::ordered_json j = {{"why", "result"}, {"passed", r.passed}, {"points", r.total}, {"verdict", r.verdict}};
    if (r.needle)
      for (const Lapse& l : r.needle->lapses) j["lapses"].push_back({l.name, l.stitch, l.value});
    if (r.needle && r.needle->join) j["join"] = {{"leak", 6e7 * r.needle->join->leak}, {"overlap", r.needle->join->overlap}, {"narrowing", r.needle->join->narrowing}};
    std::printf("%s\n", j.dump().c_str());
  }

  /// The parent goes on; the child waits for orders and never returns.
  void stay_behind(double t) {
    char pipe[256];
    std::snprintf(pipe, sizeof pipe, "%s_%.1f", name_.c_str(), t);
    unlink(pipe);
    if (mkfifo(pipe, 0600) != 0 || fork() != 0) return;
    setsid();
    for (std::string line;;) {
      std::ifstream orders(pipe);
      while (std::getline(orders, line)) {
        if (line == "quit") _exit(0);
        if (line.starts_with("go ") && fork() == 0) go_on(line);
      }
    }
  }

  [[noreturn]] void go_on(const std::string& order) {
    std::istringstream words(order);
    std::string go, script;
    double until = 0.0, stop = 0.0;
    std::vector<double> stops;
    words >> go >> name_ >> script >> until;
    while (words >> stop) stops.push_back(stop);
    if (std::freopen((name_ + ".out").c_str(), "w", stdout) == nullptr) _exit(1);
    std::printf("pid %d\n", getpid());
    try {
      take_script(script);
      run(until, stops);
    } catch (const std::exception& e) {
      std::printf("failed: %s\n", e.what());
    }
    std::printf("done\n");
    std::fflush(stdout);
    _exit(0);
  }

  World world_;
  TaskSession task_;
  SceneEyes eyes_;
  Memory memory_;
  std::unique_ptr<HapticLoop> hands_;
  std::int64_t next_us_ = 0;
  std::uint64_t moved_ = 0;  // hash of all that the hands did
  std::string name_;
  std::size_t told_ = 0;   // events
  double round_cut_ = world_.description().tissue.lumen ? 180.0 / std::numbers::pi / CutLine(world_.description().tissue).radius() : 0.0;  // [deg/m]
};

}  // namespace
}  // namespace filum

int main(int argc, char** argv) {
  if (argc < 6) return std::fprintf(stderr, "usage: filum_rehearsal ROOT TASK SCRIPT NAME UNTIL [T ...]\n"), 2;
  signal(SIGCHLD, SIG_IGN);
  try {
    std::vector<double> stops;
    for (int i = 6; i < argc; ++i) stops.push_back(std::stod(argv[i]));
    filum::Rehearsal(argv[1], argv[2], argv[3], argv[4]).run(std::stod(argv[5]), stops);
  } catch (const std::exception& e) {
    return std::fprintf(stderr, "filum_rehearsal: %s\n", e.what()), 2;
  }
  std::printf("done\n");
}
