// A pair of forceps on a pty for whoever has none: plays a demonstration file as pose and grip packets in
// real time, with as much loss and damage on the line as asked for. Prints the name of the pty; begins when
// the trainer sends its first ping.

#include <poll.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <thread>

#include "base/error.h"
#include "tests/devices/pty.h"
#include "tests/devices/script_frames.h"

namespace {

using Clock = std::chrono::steady_clock;
using Frame = std::vector<std::uint8_t>;

volatile std::sig_atomic_t stop_asked = 0;

struct Options {
  std::string script, calibration = "models/forceps/default.yaml", link;
  double rate = 1000.0;  // [1/s]
  double drop = 0.0;     // probability that a frame is lost
  double flip = 0.0;     // probability that a byte has one bit turned
  double garbage = 0.0;  // probability of a burst of random bytes after a frame
  double hold = 1.0;     // [s] the last pose is kept
  unsigned seed = 1;
  bool by_hand = false;
};

/// The line with its troubles.
class Line {
 public:
  Line(filum::Pty& pty, const Options& options) : pty_(pty), options_(options), random_(options.seed) {}

  /// False when the trainer has closed the port.
  bool send(Frame frame) {
    if (chance(options_.drop)) {
      ++dropped_;
      return true;
    }
    bool damaged = false;
    for (std::uint8_t& byte : frame) {
      if (!chance(options_.flip)) continue;
      byte = static_cast<std::uint8_t>(byte ^ (1u << (random_() % 8)));
      damaged = true;
    }
    if (chance(options_.garbage))
      for (int i = 0; i < 12; ++i) frame.push_back(static_cast<std::uint8_t>(random_()));
    damaged_ += damaged;
    ++sent_;
    return pty_.write(frame);
  }
  void report() const {
    std::fprintf(stderr, "sent %llu frames, %llu of them damaged; dropped %llu\n",
                 static_cast<unsigned long long>(sent_), static_cast<unsigned long long>(damaged_),
                 static_cast<unsigned long long>(dropped_));
  }

 private:
  bool chance(double p) { return p > 0.0 && std::uniform_real_distribution<double>()(random_) < p; }

  filum::Pty& pty_;
  const Options& options_;
  std::mt19937 random_;
  std::uint64_t sent_ = 0, damaged_ = 0, dropped_ = 0;
};

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Answers pings; true when one came.
bool answer(filum::Pty& pty, filum::FrameReader& heard, filum::ScriptFrames& frames, Line& line, double t) {
  std::uint8_t bytes[256];
  const ssize_t n = pty.read(bytes);
  bool pinged = false;
  if (n <= 0) return false;
  heard.feed(std::span(bytes, static_cast<std::size_t>(n)), [&](const filum_frame& frame) {
    filum_ping ping;
    if (!filum_get_ping(&frame, &ping)) return;
    pinged = true;
    line.send(frames.pong(ping, t));
  });
  return pinged;
}

/// Lines of standard input, "DEGREES NEWTON": what the jaws and the pad are set to.
class Hand {
 public:
  void follow(filum::ScriptFrames& frames) {
    char bytes[256];
    pollfd ready{STDIN_FILENO, POLLIN, 0};
    if (::poll(&ready, 1, 0) <= 0) return;
    const ssize_t n = ::read(STDIN_FILENO, bytes, sizeof bytes);
    if (n <= 0) return;
    text_.append(bytes, static_cast<std::size_t>(n));
    for (std::size_t end; (end = text_.find('\n')) != std::string::npos; text_.erase(0, end + 1)) {
      double degrees = 0.0, newton = 0.0;
      if (std::sscanf(text_.c_str(), "%lf %lf", &degrees, &newton) == 2) frames.hold(degrees * std::numbers::pi / 180.0, newton);
    }
  }

 private:
  std::string text_;
};

void play(const Options& options, filum::ScriptFrames& frames, filum::Pty& pty) {
  Line line(pty, options);
  filum::FrameReader heard;
  Hand hand;
  while (!stop_asked && !answer(pty, heard, frames, line, 0.0))
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  const auto start = Clock::now();
  line.send({0});
  const double end = frames.script().duration() + options.hold;
  double next_hello = 0.0;
  std::vector<Frame> now;
  for (std::uint64_t tick = 0; !stop_asked; ++tick) {
    const double due = static_cast<double>(tick) / options.rate;
    if (due > end) break;
    std::this_thread::sleep_until(
        start + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(due)));
    const double t = seconds_since(start);
    if (t > due + 1.5 / options.rate)
      tick = static_cast<std::uint64_t>(t * options.rate);  // late: skip, do not catch up
    if (t >= next_hello) {
      line.send(frames.hello(t));
      next_hello += 1.0;
    }
    now.clear();
    if (options.by_hand && tick % 16 == 0) hand.follow(frames);
    frames.append(t, now);
    bool listening = true;
    for (Frame& frame : now) listening = listening && line.send(std::move(frame));
    if (!listening && !options.by_hand) break;  // a handle goes on: the port changes hands between who watches it and who calibrates it
    answer(pty, heard, frames, line, t);
  }
  line.report();
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Plays a demonstration as serial forceps on a pty");
  Options options;
  app.add_option("script", options.script, "demonstration file (filum-demonstration/1)")->required();
  app.add_option("--calibration", options.calibration, "calibration the counts are made with");
  app.add_option("--link", options.link, "symbolic link to make to the pty");
  app.add_option("--rate", options.rate, "frames of each kind a second")->check(CLI::Range(1.0, 5000.0));
  app.add_option("--drop", options.drop, "probability that a frame is lost")->check(CLI::Range(0.0, 1.0));
  app.add_option("--flip", options.flip, "probability that a bit of a byte is turned")
      ->check(CLI::Range(0.0, 1.0));
  app.add_option("--garbage", options.garbage, "probability of random bytes after a frame")
      ->check(CLI::Range(0.0, 1.0));
  app.add_option("--hold", options.hold, "seconds the last pose is kept")->check(CLI::Range(0.0, 3600.0));
  app.add_flag("--by-hand", options.by_hand, "opening [deg] and squeeze [N] from lines of standard input");
  app.add_option("--seed", options.seed, "seed of loss and damage");
  CLI11_PARSE(app, argc, argv);
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, [](int) { stop_asked = 1; });
  try {
    filum::ScriptFrames frames(filum::PoseScript::load(options.script),
                               filum::ForcepsCalibration::load(options.calibration));
    const auto pty =
        options.link.empty() ? std::make_unique<filum::Pty>() : std::make_unique<filum::Pty>(options.link);
    std::printf("%s\n", pty->path().c_str());
    std::fflush(stdout);
    play(options, frames, *pty);
    return 0;
  } catch (const filum::InputError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
