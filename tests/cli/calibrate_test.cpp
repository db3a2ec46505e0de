// filum calibrate forceps: readings from a file or asked for one by one, the file that comes of them, refusals with their reason.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>

#include "devices/forceps_calibration.h"
#include "program_call.h"
#include "tests/devices/simulated_handle.h"
#include "tests/session/synthetic.h"

namespace filum {
namespace calibrate_test {

constexpr double kDegree = std::numbers::pi / 180.0;

/// True counts: 1000 + 80 a degree (+ `bend` a square degree), 300 + 900 a newton.
double angle_count(double degrees, double bend = 0.0) { return 1000.0 + 80.0 * degrees + bend * degrees * degrees; }
double force_count(double newtons) { return 300.0 + 900.0 * newtons; }

std::string points(double bend) {
  std::ostringstream s;
  s << "format: filum-calibration-points/1\nangle:\n";
  for (const char* way : {"upwards", "downwards", "upwards", "downwards"})
    for (const double a : {0, 5, 10, 15, 20, 25}) s << "  - { value: " << a << " deg, count: " << angle_count(a, bend) << " count, noise: 1 count, approached: " << way << " }\n";
  s << "force:\n";
  for (const char* way : {"upwards", "downwards", "upwards", "downwards"})
    for (const double f : {0.0, 0.2, 0.5, 1.0, 2.0, 3.0}) s << "  - { value: " << f << " N, count: " << force_count(f) << " count, noise: 1 count, approached: " << way << " }\n";
  return s.str();
}

TEST(Calibrate, ReadingsOnALineGiveAFileThatForcepsRead) {
  const synthetic::Folder folder;
  std::ofstream(folder.file("p.yaml")) << points(0.0);
  const std::string file = folder.file("made.yaml");
  const auto d = call({"calibrate", "forceps", "--points", folder.file("p.yaml"), "--out", file, "--identity", "7", "--sensor", "S-1", "--json"}).json();
  EXPECT_TRUE(d["good"].get<bool>());
  EXPECT_EQ(d["file"], file);
  EXPECT_NEAR(d["angle"]["gain"].get<double>(), kDegree / 80.0, 1e-9);
  EXPECT_EQ(d["angle"]["unit"], "rad");
  EXPECT_NEAR(d["force"]["gain"].get<double>(), 1.0 / 900.0, 1e-9);
  const ForcepsCalibration made = ForcepsCalibration::load(file);
  EXPECT_NEAR(made.angle(static_cast<std::uint16_t>(angle_count(10))), 10 * kDegree, 1e-6);
  EXPECT_EQ(made.identity, 7u);
  EXPECT_EQ(made.sensor, "S-1");
}

TEST(Calibrate, ACurveIsRefusedWithItsReasonAndNothingIsWritten) {
  const synthetic::Folder folder;
  std::ofstream(folder.file("p.yaml")) << points(-2.9);  // turns round within the range
  const Call c = call({"calibrate", "forceps", "--points", folder.file("p.yaml"), "--out", folder.file("made.yaml")});
  EXPECT_EQ(c.code, kFailed);
  EXPECT_NE(c.out.find("angle: refused: "), std::string::npos) << c.out;
  EXPECT_NE(c.out.find("force: 0.001111 N a count"), std::string::npos) << c.out;
  EXPECT_FALSE(std::filesystem::exists(folder.file("made.yaml")));
}

/// The operator: reads the prompt, sets the handle to what it asks for, presses Enter.
class Operator {
 public:
  Operator(SimulatedHandle& handle, std::vector<double> angles, std::vector<double> forces, int presses = 1000) : handle_(handle), angles_(std::move(angles)), forces_(std::move(forces)), presses_(presses) {
    stream_ = fopencookie(this, "r", {[](void* me, char* to, std::size_t) { return static_cast<Operator*>(me)->press(to); }, nullptr, nullptr, nullptr});
    std::setvbuf(stream_, nullptr, _IONBF, 0);
  }
  ~Operator() { std::fclose(stream_); }
  std::FILE* stream() const { return stream_; }

 private:
  ssize_t press(char* to) {
    if (presses_-- == 0) return 0;
    if (next_ < angles_.size()) handle_.angle = angle_count(angles_[next_]);
    else if (next_ < angles_.size() + forces_.size()) handle_.force = force_count(forces_[next_ - angles_.size()]);
    ++next_;
    handle_.wait();
    *to = '\n';
    return 1;
  }
  SimulatedHandle& handle_;
  std::vector<double> angles_, forces_;
  int presses_;
  std::size_t next_ = 0;
  std::FILE* stream_;
};

/// Each value from below and from above, as often as asked.
std::vector<double> there_and_back(std::vector<double> values, int repeats) {
  std::vector<double> all;
  for (int k = 0; k < repeats; ++k) {
    all.insert(all.end(), values.begin(), values.end());
    all.insert(all.end(), values.rbegin(), values.rend());
  }
  return all;
}

TEST(Calibrate, LeadsThroughTheValuesOfAHandle) {
  const synthetic::Folder folder;
  Pty pty;
  SimulatedHandle handle(pty);
  const Operator hands(handle, there_and_back({0, 6, 12, 18, 24}, 2), there_and_back({0, 0.5, 1, 2, 3}, 2));
  const Call c = call({"calibrate", "forceps", "--port", pty.path(), "--out", folder.file("made.yaml"), "--angles", "0,6,12,18,24", "--forces", "0,0.5,1,2,3", "--repeats", "2", "--json"}, hands.stream());
  const auto d = c.json();
  EXPECT_TRUE(d["good"].get<bool>()) << d;
  EXPECT_NEAR(d["angle"]["gain"].get<double>() / (kDegree / 80.0), 1.0, 1e-3);
  EXPECT_NEAR(d["force"]["gain"].get<double>() * 900.0, 1.0, 1e-3);
  EXPECT_NE(c.err.find("then press Enter"), std::string::npos);
}

TEST(Calibrate, WhatIsAskedWronglyIsNamed) {
  const synthetic::Folder folder;
  const std::string out = folder.file("made.yaml");
  std::ofstream(folder.file("kept.yaml")) << "another's";
  std::ofstream(folder.file("p.yaml")) << points(0.0);
  std::string spoilt = points(0.0);
  std::ofstream(folder.file("spoilt.yaml")) << spoilt.replace(spoilt.find("5 deg"), 5, "5 furlong");
  expect_refused({"calibrate"}, {"subcommand"});
  expect_refused({"calibrate", "forceps", "--out", out}, {"--port", "expected either --port or --points"});
  expect_refused({"calibrate", "forceps", "--out", out, "--port", folder.file("none")}, {folder.file("none"), "expected"});
  expect_refused({"calibrate", "forceps", "--out", out, "--port", folder.file("none"), "--angles", "0,5"}, {"--angles", "found 2 values", "expected at least 5"});
  expect_refused({"calibrate", "forceps", "--out", folder.file("kept.yaml"), "--points", folder.file("p.yaml")}, {"kept.yaml", "expected a file that does not exist yet"});
  expect_refused({"calibrate", "forceps", "--out", out, "--points", folder.file("spoilt.yaml")}, {"spoilt.yaml", "furlong"});
  Pty pty;
  SimulatedHandle handle(pty);
  const Operator hands(handle, {0, 6}, {}, 2);  // walks away
  const Call left = call({"calibrate", "forceps", "--port", pty.path(), "--out", out}, hands.stream());
  EXPECT_EQ(left.code, kBadInput);
  EXPECT_NE(left.err.find("standard input: found ended"), std::string::npos) << left.err;
  EXPECT_FALSE(std::filesystem::exists(out));
}

}  // namespace calibrate_test
}  // namespace filum
