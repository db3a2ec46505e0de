#pragma once
// What a guided calibration of a camera is to look at, from a page's wish. Test: tests/cli/camera_plan_test.cpp.

#include <string>

namespace filum {

struct CameraPlan {
  std::string program;       // path of filum_camera
  std::string source = "0";  // number of a camera; a video only from the command line
  std::string folder;        // for the preview and the calibration
  std::string name = "camera";
  double square = 10.0;      // [mm]
};

/// From a page's wish: source (number of a camera), square [mm], name; what is absent keeps its default. Throws InputError. `fixed_source`: of
/// the command line, empty if none; then the page's is not taken.
CameraPlan camera_plan(const std::string& json, const std::string& program, const std::string& folder, const std::string& fixed_source);

}  // namespace filum
