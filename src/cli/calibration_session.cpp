#include "cli/calibration_session.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/numbers.h"
#include "base/utc_stamp.h"
#include "devices/serial_forceps.h"
#include "haptics/haptic_loop.h"

namespace filum {
namespace {

using Json = nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds kSilent{500};
constexpr std::chrono::seconds kPatience{5};  // for the half second of samples that a reading takes

Json fit_json(const CalibrationFit& f, double scale, const char* unit) {
  Json residuals = Json::array();
  for (const double r : f.residuals) residuals.push_back(r / scale);
  return {{"good", f.good}, {"why", f.why}, {"unit", unit}, {"gain", f.gain / scale}, {"zero", f.zero}, {"uncertainty", f.uncertainty / scale},
          {"from", f.from / scale}, {"to", f.to / scale}, {"residual", f.residual / scale}, {"hysteresis", f.hysteresis / scale}, {"repeatability", f.repeatability / scale}, {"residuals", residuals}};
}

Json points_json(const std::vector<CalibrationPoint>& points, double scale) {
  Json list = Json::array();
  for (const CalibrationPoint& p : points) list.push_back({{"value", p.value / scale}, {"count", p.count}, {"noise", p.noise}, {"upwards", p.upwards}});
  return list;
}

}  // namespace

struct CalibrationSession::Reader {
  SerialForceps forceps;
  std::vector<DeviceSample> samples;
  Clock::time_point until, heard{};
  bool stale = false;  // what waits in the line is from before the value was set
};

CalibrationSession::CalibrationSession(CalibrationPlan plan) : plan_(std::move(plan)) {
  std::vector<double> angles;
  for (const double a : plan_.angles) angles.push_back(a * kDegree);
  guides_.emplace_back(CalibrationGuide::Channel::angle, angles, plan_.repeats);
  guides_.emplace_back(CalibrationGuide::Channel::force, plan_.forces, plan_.repeats);
  reader_.reset(new Reader{SerialForceps(plan_.port, ForcepsCalibration::load(plan_.root + "/models/forceps/default.yaml")), {}, {}, {}, false});
  reader_->samples.reserve(kMaxSamplesPerPoll);
  thread_ = std::thread([this] { work(); });
}

CalibrationSession::~CalibrationSession() {
  quit_ = true;
  thread_.join();
}

void CalibrationSession::read() {
  const std::lock_guard lock(guard_);
  if (at_ >= guides_.size() || guides_[at_].reading()) return;
  trouble_.clear();
  reader_->until = Clock::now() + kPatience;
  reader_->stale = true;
  guides_[at_].begin();
}

void CalibrationSession::undo() {
  const std::lock_guard lock(guard_);
  if (at_ >= guides_.size()) return;
  trouble_.clear();
  if (at_ > 0 && !guides_[at_].reading() && guides_[at_].points().empty()) --at_;
  guides_[at_].undo();
}

/// Always drains the port; what waited there when a reading was asked for does not count.
void CalibrationSession::work() {
  while (!quit_) {
    reader_->samples.clear();
    reader_->forceps.poll(steady_now_us(), reader_->samples);
    const bool emptied = reader_->samples.size() < kMaxSamplesPerPoll / 2;
    {
      const std::lock_guard lock(guard_);
      if (reader_->stale) {
        reader_->stale = !emptied;
        reader_->samples.clear();
      }
      if (!reader_->samples.empty()) reader_->heard = Clock::now();
      if (Clock::now() - reader_->heard > kSilent) live_[0] = live_[1] = -1.0;
      for (const DeviceSample& sample : reader_->samples) {
        if (sample.raw_angle != 0 || sample.has_grip_angle) live_[0] = sample.has_grip_angle ? sample.raw_angle : -1.0;
        if (sample.raw_force != 0 || sample.has_grip_force) live_[1] = sample.has_grip_force ? sample.raw_force : -1.0;
      }
      if (at_ < guides_.size() && guides_[at_].reading()) {
        CalibrationGuide& guide = guides_[at_];
        for (const DeviceSample& sample : reader_->samples) guide.take(sample);
        if (guide.reading() && Clock::now() > reader_->until) {
          guide.again();
          trouble_ = "No reading within 5 s: is the handle plugged in, is a wire broken? The same value again.";
        }
        if (guide.unsteady() > 0.0 && trouble_.empty()) {
          char text[100];
          std::snprintf(text, sizeof text, "The reading was not steady (%.0f counts): hold it still. The same value again.", guide.unsteady());
          trouble_ = text;
        }
        if (guide.done() && ++at_ == guides_.size()) finish();
      }
    }
    if (emptied) std::this_thread::sleep_for(std::chrono::milliseconds(2));  // else behind, where the machine is busy: it would never catch up
  }
}

void CalibrationSession::finish() {
  const CalibrationReadings readings{guides_[0].points(), guides_[1].points()};
  angle_ = fit_line(readings.angle, {}, "deg", kDegree);
  force_ = fit_line(readings.force, {}, "N", 1.0);
  if (!angle_.good || !force_.good) return;
  std::error_code error;
  std::filesystem::create_directories(plan_.folder, error);
  const std::string path = plan_.folder + "/" + plan_.name + "-" + utc_stamp("%Y%m%d-%H%M%S") + ".yaml";
  const CalibrationHeader header{plan_.name, plan_.sensor, utc_stamp("%Y-%m-%d"), plan_.identity, 1.2 * std::max(-angle_.from, angle_.to), 1.2 * force_.to};
  std::ofstream file(path);
  file << calibration_text(header, readings, angle_, force_);
  if (file.flush()) file_ = path;
  else trouble_ = path + " cannot be written";
}

std::string CalibrationSession::file() const {
  const std::lock_guard lock(guard_);
  return file_;
}

Json CalibrationSession::status() const {
  const std::lock_guard lock(guard_);
  const bool done = at_ >= guides_.size();
  const std::size_t per = 2 * static_cast<std::size_t>(plan_.repeats);
  Json json = {{"state", done ? (file_.empty() ? "refused" : "done") : guides_[at_].reading() ? "reading" : "asking"},
               {"port", plan_.port},
               {"channel", at_ == 0 ? "angle" : "force"},
               {"instruction", done ? "" : guides_[at_].instruction()},
               {"taken", guides_[0].points().size() + guides_[1].points().size()},
               {"of", per * (plan_.angles.size() + plan_.forces.size())},
               {"progress", done ? 1.0 : guides_[at_].progress()},
               {"live", done || live_[at_] < 0.0 ? Json(nullptr) : Json(live_[at_])},
               {"trouble", trouble_},
               {"file", file_},
               {"angle", points_json(guides_[0].points(), kDegree)},
               {"force", points_json(guides_[1].points(), 1.0)}};
  if (done) json["fits"] = {{"angle", fit_json(angle_, kDegree, "deg")}, {"force", fit_json(force_, 1.0, "N")}};
  return json;
}

}  // namespace filum
