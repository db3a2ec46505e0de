// filum doctor: is this machine fast enough, which devices are there, is the store sound; with advice for what is not.

#include <CLI/CLI.hpp>
#include <sys/statvfs.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <boost/version.hpp>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>
#include <vector>

#include "base/error.h"
#include "cli/driven_task.h"
#include "cli/options.h"
#include "cli/setup.h"
#include "devices/sample_faults.h"
#include "devices/serial_forceps.h"
#include "haptics/haptic_loop.h"
#include "session/recorder.h"
#include "session/store.h"
#include "world/world.h"

namespace filum {
namespace {

namespace fs = std::filesystem;

struct DoctorOptions {
  CommonOptions common;
  std::string store, viewer, serial, forceps;
};

struct Check {
  std::string name;
  bool ok = false;
  std::string detail;
  std::string advice;  // empty when ok
};

std::string number(double x, int digits) {
  char text[40];
  std::snprintf(text, sizeof text, "%.*f", digits, x);
  return text;
}

Check check_cores() {
  const unsigned cores = std::thread::hardware_concurrency();
  const bool ok = cores >= 2;
  return {"cores", ok, std::to_string(cores) + " processor cores",
          ok ? "" : "The world and the scoring need a core each: use a machine with two or more."};
}

Check check_timer() {
  constexpr std::int64_t kPeriod = 1000;
  constexpr int kTurns = 300;
  std::vector<std::int64_t> late;
  std::int64_t next = steady_now_us() + kPeriod;
  for (int i = 0; i < kTurns; ++i, next += kPeriod) {
    const timespec due{static_cast<time_t>(next / 1'000'000), static_cast<long>(next % 1'000'000) * 1000};
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &due, nullptr) == EINTR) {}
    late.push_back(std::max<std::int64_t>(0, steady_now_us() - next));
  }
  std::sort(late.begin(), late.end());
  const std::int64_t p50 = late[kTurns / 2], p95 = late[kTurns * 95 / 100], most = late.back();
  const bool ok = p95 < kPeriod;
  return {"timer", ok,
          "1 kHz loop over 0.3 s: late by " + std::to_string(p50) + " us (median), " + std::to_string(p95) + " us (p95), " +
              std::to_string(most) + " us (most)",
          ok ? "" : "Close other programs; on a laptop plug in the charger; a virtual machine needs cores of its own."};
}

constexpr double kFirstThrow = 13.0;              // [s], of the demonstration, in which the first throw is laid and drawn tight
constexpr std::int64_t kMostPatience = 8'000'000;  // [us]

/// How long each step of the square knot's first throw takes [ms], by its demonstration at full speed. A machine too slow for it is
/// asked for no more than kMostPatience.
std::vector<double> first_throw_steps(const std::string& root, double& dt) {
  const DrivenTask task = driven_task(root, "knot-square");
  World world(task.model);
  dt = world.description().dt;
  std::vector<double> ms;
  const std::int64_t give_up = steady_now_us() + kMostPatience;
  while (world.observation().time < kFirstThrow && steady_now_us() < give_up) {
    const Inputs inputs = task.inputs(world);
    const std::int64_t begin = steady_now_us();
    world.step(inputs);
    ms.push_back(1e-3 * static_cast<double>(steady_now_us() - begin));
  }
  return ms;
}

/// Times real time of the slowest second of scene; a last part of a second counts as the rest of one.
double slowest_second(const std::vector<double>& ms, double dt) {
  const auto window = std::min(ms.size(), static_cast<std::size_t>(1.0 / dt + 0.5));
  double sum = 0.0, most = 0.0;
  for (std::size_t i = 0; i < ms.size(); ++i) {
    sum += ms[i] - (i >= window ? ms[i - window] : 0.0);
    if (i + 1 >= window) most = std::max(most, sum);
  }
  return most > 0.0 ? 1e3 * dt * static_cast<double>(window) / most : 0.0;
}

/// A late step is made up for by those after it; a second in which there are too many of them is seen as slow motion.
Check check_speed(const std::string& root) {
  double dt = 0.0;
  std::vector<double> ms = first_throw_steps(root, dt);
  const double slowest = slowest_second(ms, dt), seconds = static_cast<double>(ms.size()) * dt;
  const auto late = std::count_if(ms.begin(), ms.end(), [dt](double one) { return one > 1e3 * dt; });
  std::sort(ms.begin(), ms.end());
  const bool whole = seconds >= kFirstThrow - 1.5 * dt, ok = whole && slowest >= 1.0;
  return {"speed", ok,
          "first throw of knot-square, " + number(seconds, 1) + " s" + (whole ? "" : " of " + number(kFirstThrow, 1) + " (then given up)") + " at full speed: step " +
              number(ms[ms.size() / 2], 2) + " ms (median), " + number(ms[ms.size() * 99 / 100], 2) + " ms (p99), of " + number(1e3 * dt, 1) + " ms there are; " +
              std::to_string(late) + " of " + std::to_string(ms.size()) + " steps late; slowest second at " + number(slowest, 2) + " times real time",
          ok ? "" : "A knot will be tied in slow motion at times, and the trainer says so. Use a faster machine or close other programs."};
}

Check check_devices(const std::string& serial) {
  std::vector<std::string> ports;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator("/dev", error)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("ttyACM") || name.starts_with("ttyUSB")) ports.push_back(entry.path().string());
  }
  std::sort(ports.begin(), ports.end());
  std::string detail = ports.empty() ? "no serial port; the pointer in the browser always works" : "serial ports:";
  bool ok = true;
  for (const std::string& port : ports) {
    const bool open = access(port.c_str(), R_OK | W_OK) == 0;
    detail += " " + port + (open ? "" : " (no permission)");
    ok = ok && open;
  }
  if (!serial.empty() && access(serial.c_str(), R_OK | W_OK) != 0) {
    return {"devices", false, detail + "; " + serial + " cannot be opened", "Plug the forceps in, or give the port that is there."};
  }
  return {"devices", ok, detail, ok ? "" : "Add yourself to the group of the port (usually dialout) and log in again."};
}

/// Listens to the handle for two seconds: what it is, what is lost, its clock, and whether the calibration in use is its own.
Check check_handle(const DoctorOptions& o) {
  SerialForceps handle(o.serial, ForcepsCalibration::load(o.forceps.empty() ? o.common.root + "/models/forceps/default.yaml" : o.forceps));
  std::vector<DeviceSample> samples;
  samples.reserve(kMaxSamplesPerPoll);
  std::uint32_t faults = 0;
  const std::int64_t begin = steady_now_us();
  for (std::int64_t now = begin; now < begin + 2'000'000; now = steady_now_us()) {
    samples.clear();
    handle.poll(now, samples);
    for (const DeviceSample& s : samples) faults |= s.buttons & ~kButtonBits;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  const ForcepsStream& stream = handle.stream();
  const DeviceHealth health = handle.health();
  if (health.received == 0) return {"handle", false, o.serial + " says nothing", "Is it the right port, is the firmware on it, does it run at 500 kbit/s?"};
  std::string detail = std::to_string(health.received / 2) + " samples/s, " + std::to_string(health.lost) + " lost, " + std::to_string(health.corrupt) + " corrupt";
  if (stream.hello()) {
    const filum_hello& hello = *stream.hello();
    detail += ", firmware " + std::to_string(hello.firmware[0]) + "." + std::to_string(hello.firmware[1]) + "." + std::to_string(hello.firmware[2]) + ", calibration " + std::to_string(hello.calibration);
  }
  if (stream.clock().known())
    detail += ", clock offset " + std::to_string(stream.clock().offset_us()) + " +- " + std::to_string(stream.clock().uncertainty_us()) + " us";
  if (stream.calibration_differs()) return {"handle", false, detail, "The calibration in use is not this handle's: give it with --forceps, or calibrate again."};
  if (faults & (kAngleBroken | kForceBroken)) return {"handle", false, detail, "A wire of its sensors is broken or shorted."};
  if (faults != 0) return {"handle", false, detail, "An amplifier is at the end of its range: trim it, see hardware/forceps."};
  const bool sound = health.lost == 0 && health.corrupt == 0;
  return {"handle", sound, detail, sound ? "" : "Use a shorter cable, another port or an isolator."};
}

const char* advice_for(StoreTrouble trouble) {
  switch (trouble) {
    case StoreTrouble::kNoFolder: return "Give a folder, or the name of one that can be made, with --store.";
    case StoreTrouble::kNotWritable: return "Choose a folder that you may write with --store, or ask its owner for the right.";
    case StoreTrouble::kNewer: return "Use the newer Filum that made it, or choose another folder with --store.";
    case StoreTrouble::kLocked: return "End the other program that uses the store; nothing in it was changed.";
    case StoreTrouble::kNoRoom: return "Make room on the disk of the store, or choose another folder with --store.";
    case StoreTrouble::kDatabase: break;
  }
  return "End other programs that use the store, see that its files may be written and that the disk has room.";
}

Check check_store(const std::string& folder) {
  try {
    const Store store(folder);
    const auto problems = store.check(false);
    struct statvfs disk {};
    const double free_gb = statvfs(folder.c_str(), &disk) == 0
                               ? 1e-9 * static_cast<double>(disk.f_bavail) * static_cast<double>(disk.f_frsize)
                               : 0.0;
    const auto sessions = store.list();
    const auto cut_short = std::count_if(sessions.begin(), sessions.end(), [](const StoreEntry& e) { return !e.finished; });
    std::string detail = folder + ": " + std::to_string(sessions.size()) + " sessions" + (cut_short > 0 ? " (" + std::to_string(cut_short) + " cut short or running)" : "") + ", " + number(free_gb, 1) + " GB free";
    if (!problems.empty()) return {"store", false, detail + "; " + problems[0].id + ": " + problems[0].what, problems[0].advice};
    const bool room = free_gb > 0.5;
    return {"store", room, detail, room ? "" : "Make room on the disk: a session takes a few megabytes a minute."};
  } catch (const StoreError& error) {
    return {"store", false, error.what(), advice_for(error.trouble)};
  }
}

Check check_viewer(const std::string& folder) {
  const bool ok = fs::is_regular_file(fs::path(folder) / "index.html");
  return {"viewer", ok, ok ? folder : folder + " holds no built viewer", ok ? "" : "Run ./filum, which builds it."};
}

Check check_files(const std::string& root) {
  std::vector<std::string> problems;
  const std::size_t n = load_tasks(root, problems).size();
  const bool ok = problems.empty() && n > 0;
  return {"files", ok, std::to_string(n) + " tasks in " + root + (ok || problems.empty() ? "" : "; " + problems[0]),
          ok ? "" : "Restore models/ and curricula/, or give their folder with --root."};
}

Check check_versions() {
  return {"versions", true,
          program_text() + ", Boost " + std::to_string(BOOST_VERSION / 100000) + "." + std::to_string(BOOST_VERSION / 100 % 1000) +
              ", Eigen " + std::to_string(EIGEN_WORLD_VERSION) + "." + std::to_string(EIGEN_MAJOR_VERSION) + "." +
              std::to_string(EIGEN_MINOR_VERSION) + ", recording format " + std::to_string(kRecordingFormat),
          ""};
}

template <class Function>
Check guarded(const char* name, Function check, const char* advice = "Restore the file named, or give another folder with --root.") {
  try {
    return check();
  } catch (const std::exception& error) {
    return {name, false, error.what(), advice};
  }
}

int run(const DoctorOptions& o, const Streams& io) {
  if (!o.forceps.empty() && o.serial.empty()) throw InputError("--forceps", "calibration", o.forceps, "--serial PATH beside it");
  std::vector<Check> checks = {
      check_cores(),
      check_timer(),
      guarded("speed", [&] { return check_speed(o.common.root); }),
      check_devices(o.serial),
      guarded("store", [&] { return check_store(o.store.empty() ? default_store_folder() : o.store); }, "Move the file named out of the store, or choose another folder with --store."),
      check_viewer(o.viewer),
      check_files(o.common.root),
      check_versions(),
  };
  if (!o.serial.empty()) checks.push_back(guarded("handle", [&] { return check_handle(o); }, "Plug the forceps in, give the port that is there, and end what else uses it."));
  const bool ok = std::all_of(checks.begin(), checks.end(), [](const Check& c) { return c.ok; });
  if (o.common.json) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const Check& c : checks) list.push_back({{"name", c.name}, {"ok", c.ok}, {"detail", c.detail}, {"advice", c.advice}});
    print_json(io.out, {{"ok", ok}, {"checks", list}});
  } else {
    for (const Check& c : checks) {
      std::fprintf(io.out, "%-5s %-9s %s\n", c.ok ? "ok" : "NOT", c.name.c_str(), c.detail.c_str());
      if (!c.advice.empty()) std::fprintf(io.out, "                %s\n", c.advice.c_str());
    }
  }
  return ok ? kDone : kFailed;
}

}  // namespace

void add_doctor(CLI::App& app, Action& action) {
  auto o = std::make_shared<DoctorOptions>();
  CLI::App* command = app.add_subcommand("doctor", "Check this machine, its devices and the store");
  command->add_option("--store", o->store, "Folder of the recordings (default: your data folder)");
  o->viewer = std::string(source_folder()) + "/src/viewer/dist";
  command->add_option("--viewer", o->viewer, "Folder of the built viewer")->capture_default_str();
  command->add_option("--serial", o->serial, "Serial port of the forceps");
  command->add_option("--forceps", o->forceps, "Calibration of the forceps that is to be used with it");
  add_common(*command, o->common);
  command->callback([o, &action] { action.run = [o](const Streams& io) { return run(*o, io); }; });
}

}  // namespace filum
