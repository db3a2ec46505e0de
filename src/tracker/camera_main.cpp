// filum_camera: markers seen by a camera or in a video to poses by OpenIGTLink; markers to print; camera calibration.
//   filum_camera sheet --out markers.svg [--side 12]
//   filum_camera calibrate --pictures FOLDER --square 10 --out camera.yaml
//   filum_camera track --camera camera.yaml --source 0|VIDEO [--port 18944] [--side 12]
// Tool N carries marker N; the pose sent is the marker's, in the camera's frame.
#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "base/error.h"
#include "devices/igtl_stream.h"
#include "tracker/marker_sheet.h"
#include "tracker/marker_tracker.h"

namespace {

using namespace filum;

struct Options {
  std::string out, pictures, camera, source = "0";
  double side = 12.0, square = 10.0;  // [mm]
  int port = 18944;
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

int track(const Options& o) {
  const CameraModel camera = CameraModel::load(o.camera);
  MarkerOptions options;
  for (int tool = 0; tool < 3; ++tool) options.mounts[tool] = {tool, 1e-3 * o.side, {}};
  MarkerTracker tracker(camera, options);
  cv::VideoCapture capture;
  const bool number = o.source.find_first_not_of("0123456789") == std::string::npos && o.source.size() < 4;
  if (!(number ? capture.open(std::stoi(o.source)) : capture.open(o.source))) throw InputError("--source", "camera", o.source, "a camera's number or a video");
  IgtlStream stream("127.0.0.1", o.port);
  const auto start = std::chrono::steady_clock::now();
  for (cv::Mat frame, grey; capture.read(frame);) {
    if (frame.cols != camera.width || frame.rows != camera.height)
      throw InputError("--camera", "size", std::to_string(frame.cols) + " x " + std::to_string(frame.rows), "pictures of the size of the calibration");
    cv::cvtColor(frame, grey, cv::COLOR_BGR2GRAY);
    const auto us = std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::steady_clock::now() - start).count();
    for (const MarkerPose& pose : tracker.find(grey)) stream.send(pose.tool, pose.X_CT, us);
  }
  const MarkerCounts& n = tracker.counts();
  std::printf("%llu pictures, %llu poses, %llu ambiguous, %llu poor, %llu unknown markers\n", static_cast<unsigned long long>(n.frames),
              static_cast<unsigned long long>(n.poses), static_cast<unsigned long long>(n.ambiguous), static_cast<unsigned long long>(n.poor),
              static_cast<unsigned long long>(n.unknown));
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
  tracking->add_option("--camera", o.camera, "Calibration")->required();
  tracking->add_option("--source", o.source, "Number of a camera, or a video");
  tracking->add_option("--port", o.port)->check(CLI::Range(1, 65535));
  tracking->add_option("--side", o.side, "Side of a marker [mm]")->check(CLI::Range(3.0, 100.0));
  CLI11_PARSE(app, argc, argv);
  try {
    if (sheet->parsed()) write(o.out, marker_sheet_svg({0, 1, 2, 3}, o.side));
    if (calibration->parsed()) return calibrate(o);
    if (tracking->parsed()) return track(o);
    return 0;
  } catch (const InputError& error) {
    std::fprintf(stderr, "filum_camera: %s\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "filum_camera: %s\n", error.what());
    return 1;
  }
}
