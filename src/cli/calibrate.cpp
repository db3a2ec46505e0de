// filum calibrate forceps: leads through the calibration of a pair of forceps in the terminal, fits it and writes its file.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "base/error.h"
#include "base/file_kind.h"
#include "base/numbers.h"
#include "base/utc_stamp.h"
#include "cli/options.h"
#include "devices/calibration_file.h"
#include "devices/calibration_guide.h"
#include "devices/serial_forceps.h"
#include "haptics/haptic_loop.h"

namespace filum {
namespace {

struct CalibrateOptions {
  CommonOptions common;
  std::string port, points, out, sensor = "unknown", name = "forceps";
  std::vector<double> angles = {0, 5, 10, 15, 20, 25};      // [deg]
  std::vector<double> forces = {0, 0.2, 0.5, 1.0, 2.0, 3.0}; // [N]
  int repeats = 3;
  unsigned identity = 1;
};

/// Reads one value; false when the handle fell silent or a wire is broken.
bool read_value(SerialForceps& forceps, CalibrationGuide& guide) {
  using Clock = std::chrono::steady_clock;
  std::vector<DeviceSample> samples;
  samples.reserve(kMaxSamplesPerPoll);
  for (bool waiting = true; waiting; samples.clear()) {  // what waited in the line, up to seconds of it, is from before the value was set
    forceps.poll(steady_now_us(), samples);
    waiting = !samples.empty();
  }
  guide.begin();
  const auto end = Clock::now() + std::chrono::seconds(5);
  while (guide.reading() && Clock::now() < end) {
    forceps.poll(steady_now_us(), samples);
    for (const DeviceSample& sample : samples) guide.take(sample);
    samples.clear();
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  const bool read = !guide.reading();
  if (!read) guide.again();
  return read;
}

/// Waits for Enter; false when the input has ended.
bool entered(std::FILE* in) {
  int read = std::fgetc(in);
  while (read != '\n' && read != EOF) read = std::fgetc(in);
  return read == '\n';
}

std::vector<CalibrationPoint> guide_through(SerialForceps& forceps, CalibrationGuide guide, const Streams& io) {
  while (!guide.done()) {
    std::fprintf(io.err, "%s, then press Enter: ", guide.instruction().c_str());
    if (!entered(io.in)) throw InputError("calibrate", "standard input", "ended", "Enter for each value");
    if (!read_value(forceps, guide)) {
      std::fprintf(io.err, "  no reading within 5 s: is the handle plugged in, is a wire broken? Again.\n");
      continue;
    }
    if (guide.unsteady() > 0.0) {
      std::fprintf(io.err, "  not steady (%.1f counts): hold it still. Again.\n", guide.unsteady());
      continue;
    }
    std::fprintf(io.err, "  %.1f counts, noise %.1f\n", guide.points().back().count, guide.points().back().noise);
  }
  return guide.points();
}

CalibrationReadings readings_from_port(const CalibrateOptions& o, const Streams& io) {
  SerialForceps forceps(o.port, ForcepsCalibration::load(o.common.root + "/models/forceps/default.yaml"));
  std::vector<double> angles;
  for (double degrees : o.angles) angles.push_back(degrees * kDegree);
  CalibrationReadings readings;
  readings.angle = guide_through(forceps, {CalibrationGuide::Channel::angle, angles, o.repeats}, io);
  readings.force = guide_through(forceps, {CalibrationGuide::Channel::force, o.forces, o.repeats}, io);
  const ClockDrift& drift = forceps.stream().drift();
  if (drift.known()) {
    const auto line = drift.at(steady_now_us());
    std::fprintf(io.err, "clock of the handle: %.1f +- %.1f ppm against this machine's\n", line.drift_ppm, line.drift_uncertainty_ppm);
  }
  return readings;
}

nlohmann::ordered_json fit_json(const CalibrationFit& f, const std::string& unit) {
  return {{"good", f.good}, {"why", f.why}, {"gain", f.gain}, {"zero", f.zero}, {"unit", unit}, {"uncertainty", f.uncertainty},
          {"residual", f.residual}, {"hysteresis", f.hysteresis}, {"repeatability", f.repeatability}, {"from", f.from}, {"to", f.to}};
}

void print_fit(const char* name, const CalibrationFit& f, double scale, const char* unit, const Streams& io) {
  if (!f.good) {
    std::fprintf(io.out, "%s: refused: %s\n", name, f.why.c_str());
    return;
  }
  std::fprintf(io.out, "%s: %.4g %s a count, uncertainty %.3g %s (residual %.3g, hysteresis %.3g, repeatability %.3g), valid from %.4g to %.4g %s\n",
              name, f.gain / scale, unit, f.uncertainty / scale, unit, f.residual / scale, f.hysteresis / scale,
              f.repeatability / scale, f.from / scale, f.to / scale, unit);
}

int run(const CalibrateOptions& o, const Streams& io) {
  if (o.port.empty() == o.points.empty()) throw InputError("calibrate", "--port", o.port, "either --port or --points");
  if (o.points.empty() && std::min(o.angles.size(), o.forces.size()) < 5)
    throw InputError("calibrate", "--angles, --forces", std::to_string(std::min(o.angles.size(), o.forces.size())) + " values", "at least 5");
  if (is_there(o.out)) throw InputError("calibrate", "--out", o.out, "a file that does not exist yet");
  const CalibrationReadings readings = o.points.empty() ? readings_from_port(o, io) : load_readings(o.points);
  const CalibrationFit angle = fit_line(readings.angle, {}, "deg", kDegree);
  const CalibrationFit force = fit_line(readings.force, {}, "N", 1.0);
  const bool good = angle.good && force.good;
  if (good) {
    const CalibrationHeader header{o.name, o.sensor, utc_stamp("%Y-%m-%d"), o.identity, 1.2 * std::max(-angle.from, angle.to), 1.2 * force.to};
    std::ofstream file(o.out);
    file << calibration_text(header, readings, angle, force);
    if (!file.flush()) throw InputError("calibrate", "--out", o.out, "a file that can be written");
  }
  if (o.common.json) {
    print_json(io.out, {{"good", good}, {"angle", fit_json(angle, "rad")}, {"force", fit_json(force, "N")}, {"file", good ? o.out : ""}});
  } else {
    print_fit("angle", angle, kDegree, "deg", io);
    print_fit("force", force, 1.0, "N", io);
    if (good) std::fprintf(io.out, "written to %s; use it with --forceps %s\n", o.out.c_str(), o.out.c_str());
  }
  return good ? kDone : kFailed;
}

}  // namespace

void add_calibrate(CLI::App& app, Action& action) {
  auto o = std::make_shared<CalibrateOptions>();
  CLI::App* command = app.add_subcommand("calibrate", "Calibrate a device");
  command->require_subcommand(1);
  CLI::App* forceps = command->add_subcommand("forceps", "Opening angle from strain, squeeze from pressure");
  forceps->add_option("--port", o->port, "Serial port of the forceps");
  forceps->add_option("--points", o->points, "Readings taken before (filum-calibration-points/1) instead of a port");
  forceps->add_option("--out", o->out, "Calibration file to write")->required();
  forceps->add_option("--sensor", o->sensor, "Serial number of the handle");
  forceps->add_option("--name", o->name, "Name of the handle");
  forceps->add_option("--identity", o->identity, "Identity of this calibration, as it is stored in the handle");
  forceps->add_option("--angles", o->angles, "Openings to set [deg], growing")->delimiter(',');
  forceps->add_option("--forces", o->forces, "Loads to put on the pad [N], growing")->delimiter(',');
  forceps->add_option("--repeats", o->repeats, "Times each value is approached from below and from above")->check(CLI::Range(2, 20));
  add_common(*forceps, o->common);
  forceps->callback([o, &action] { action.run = [o](const Streams& io) { return run(*o, io); }; });
}

}  // namespace filum
