// filum_camera: markers seen by a camera or in a video to poses by OpenIGTLink; markers to print; camera calibration.
//   filum_camera sheet --out markers.svg [--side 12]
//   filum_camera calibrate --pictures FOLDER --square 10 --out camera.yaml
//   filum_camera guide --source 0|VIDEO --folder FOLDER [--square 10]        (what the trainer's page Laboratory runs)
//   filum_camera pivot --camera camera.yaml --source 0|VIDEO --tool 0        (the tip in the marker's frame)
//   filum_camera track --camera camera.yaml --source 0|VIDEO [--field] [--tip0 X,Y,Z] [--log FILE] [--port 18944] [--side 12]
// Tool N carries marker N; the pose sent is that of the tip, in the frame of marker 3 on the table (--field) or the camera's.
#include <CLI/CLI.hpp>
#include <array>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <opencv2/imgcodecs.hpp>
#include <optional>

#include "base/error.h"
#include "devices/igtl_stream.h"
#include "tracker/field_frame.h"
#include "tracker/guide_program.h"
#include "tracker/marker_sheet.h"
#include "tracker/marker_tracker.h"
#include "tracker/picture_source.h"
#include "tracker/pose_log.h"

namespace {

using namespace filum;

constexpr int kFieldMarker = 3;  // flat on the table, x to the right, y away from the trainee

std::atomic<bool> quit{false};
static_assert(std::atomic<bool>::is_always_lock_free);

void on_signal(int) { quit.store(true); }

struct Options {
  std::string out, pictures, camera, source = "0", log;
  double side = 12.0, square = 10.0;      // [mm]
  std::array<std::vector<double>, 3> tips{{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}};  // [mm], jaw tip in its marker's frame
  int port = 18944, tool = 0;
  bool field = false;
  GuideOptions guide;
};

void write(const std::string& path, const std::string& text) {
  std::ofstream file(path);
  file << text;
  if (!file.flush()) throw InputError("--out", "file", path, "a file that can be written");
}

int calibrate(const Options& o) {
  std::vector<std::string> files;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(o.pictures, error)) files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  std::vector<cv::Mat> pictures;
  for (const std::string& file : files) {
    cv::Mat picture = cv::imread(file, cv::IMREAD_GRAYSCALE);
    if (!picture.empty()) pictures.push_back(picture);
  }
  if (pictures.empty()) throw InputError("--pictures", "folder", o.pictures, "a folder with pictures of the board");
  ChessBoard board;
  board.square = 1e-3 * o.square;
  const CameraModel model = calibrate_camera(pictures, board);
  write(o.out, model.text());
  std::printf("residual %.3f px from %d views\n", model.residual, model.views);
  return 0;
}

MarkerTracker tracker_of(const Options& o) {
  MarkerOptions options;
  for (int tool = 0; tool < 3; ++tool) {
    const std::vector<double>& tip = o.tips[static_cast<std::size_t>(tool)];
    options.mounts[tool] = {tool, 1e-3 * o.side, {1e-3 * Vec3(tip[0], tip[1], tip[2]), Quat::Identity()}};
  }
  options.mounts[kFieldMarker] = {kFieldMarker, 1e-3 * o.side, {}};
  return {CameraModel::load(o.camera), options};
}

/// Reads a picture and refuses one of another size than the camera's calibration.
bool next_picture(PictureSource& source, const CameraModel& camera, cv::Mat& grey) {
  if (!source.read(grey)) return false;
  if (grey.cols != camera.width || grey.rows != camera.height)
    throw InputError("--camera", "size", std::to_string(grey.cols) + " x " + std::to_string(grey.rows), "pictures of the size of the calibration");
  return true;
}

void print_counts(const MarkerCounts& n) {
  const auto number = [](std::uint64_t k) { return static_cast<unsigned long long>(k); };
  std::printf("%llu pictures, %llu poses, %llu ambiguous, %llu poor, %llu covered, %llu blurred, %llu unknown markers\n", number(n.frames), number(n.poses),
              number(n.ambiguous), number(n.poor), number(n.covered), number(n.blurred), number(n.unknown));
}

int track(const Options& o) {
  const CameraModel camera = CameraModel::load(o.camera);
  MarkerTracker tracker = tracker_of(o);
  PictureSource source(o.source);
  IgtlStream stream("127.0.0.1", o.port);
  std::optional<PoseLog> log;
  if (!o.log.empty()) log.emplace(o.log);
  FieldFrame field;
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
  for (cv::Mat grey; !quit && next_picture(source, camera, grey);) {
    const std::vector<MarkerPose> seen = tracker.find(grey);
    for (const MarkerPose& pose : seen)
      if (pose.tool == kFieldMarker) field.take(pose.X_CT);
    if (o.field && !field.X_WC()) continue;
    for (const MarkerPose& pose : seen) {
      if (pose.tool == kFieldMarker) continue;
      const Pose X = o.field ? *field.X_WC() * pose.X_CT : pose.X_CT;
      stream.send(pose.tool, X, static_cast<std::int64_t>(1e6 * source.seconds()));
      if (log) log->add(source.seconds(), pose, X);
    }
  }
  if (log) log->close();
  print_counts(tracker.counts());
  if (o.field) std::printf("field: spread of its marker %.2f mm, measured again %d times\n", 1e3 * field.spread(), field.times_lost());
  return 0;
}

/// Tip of a tool in its marker's frame.
int pivot(const Options& o) {
  const CameraModel camera = CameraModel::load(o.camera);
  MarkerTracker tracker = tracker_of(o);
  PictureSource source(o.source);
  std::vector<Pose> poses;
  for (cv::Mat grey; poses.size() < 300 && next_picture(source, camera, grey);)
    for (const MarkerPose& pose : tracker.find(grey))
      if (pose.tool == o.tool) poses.push_back(pose.X_CT);
  const Pivot p = pivot_of(poses);
  std::printf("--tip%d %.3f,%.3f,%.3f   (mm in the marker's frame; residual %.2f mm rms from %zu poses, turned by %.0f deg)\n", o.tool, 1e3 * p.tip.x(), 1e3 * p.tip.y(),
              1e3 * p.tip.z(), 1e3 * p.residual, poses.size(), p.turned * 180.0 / std::numbers::pi);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Camera tracker of the microsurgery trainer");
  app.require_subcommand(1);
  Options o;
  auto* sheet = app.add_subcommand("sheet", "Markers to print");
  sheet->add_option("--out", o.out)->required();
  sheet->add_option("--side", o.side, "Side of a marker [mm]")->check(CLI::Range(3.0, 100.0));
  auto* calibration = app.add_subcommand("calibrate", "Camera from pictures of a chessboard with 9 x 6 inner corners");
  calibration->add_option("--pictures", o.pictures, "Folder of pictures")->required();
  calibration->add_option("--square", o.square, "Side of a square [mm]")->check(CLI::Range(1.0, 200.0));
  calibration->add_option("--out", o.out)->required();
  auto* tracking = app.add_subcommand("track", "Poses of the markers by OpenIGTLink, from 127.0.0.1");
  tracking->add_option("--port", o.port)->check(CLI::Range(1, 65535));
  tracking->add_flag("--field", o.field, "Poses in the frame of marker 3 on the table instead of the camera's");
  tracking->add_option("--log", o.log, "Write poses and covariances to this new CSV file");
  auto* tipping = app.add_subcommand("pivot", "Tip of a tool in its marker's frame: turn the handle while the tip rests in a hollow");
  tipping->add_option("--tool", o.tool)->check(CLI::Range(0, 2));
  for (CLI::App* sub : {tracking, tipping}) {
    sub->add_option("--camera", o.camera, "Calibration")->required();
    sub->add_option("--source", o.source, "Number of a camera, or a video");
    sub->add_option("--side", o.side, "Side of a marker [mm]")->check(CLI::Range(3.0, 100.0));
  }
  for (std::size_t tool = 0; tool < o.tips.size(); ++tool)
    tracking->add_option("--tip" + std::to_string(tool), o.tips[tool], "Its jaw tip in the marker's frame [mm], as `pivot` prints it")->delimiter(',')->expected(3)->check(CLI::Range(-300.0, 300.0));
  auto* guiding = app.add_subcommand("guide", "Guided calibration: commands in, states out (see guide_program.h)");
  guiding->add_option("--source", o.guide.source, "Number of a camera, or a video");
  guiding->add_option("--folder", o.guide.folder, "For the preview and the calibration")->required();
  guiding->add_option("--name", o.guide.camera, "Name of the camera");
  guiding->add_option("--square", o.guide.square, "Side of a square [mm]")->check(CLI::Range(1.0, 200.0));
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  try {
    if (sheet->parsed()) write(o.out, marker_sheet_svg({0, 1, 2, 3}, o.side));
    if (calibration->parsed()) return calibrate(o);
    if (tracking->parsed()) return track(o);
    if (tipping->parsed()) return pivot(o);
    if (guiding->parsed()) return run_guide(o.guide);
    return 0;
  } catch (const InputError& error) {
    std::fprintf(stderr, "filum_camera: %s\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "filum_camera: %s\n", error.what());
    return 1;
  }
}
