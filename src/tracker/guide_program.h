#pragma once
// filum_camera guide: the guided calibration of a camera for whoever shows it. Each line of standard input is a command ("undo",
// "calibrate", "quit"; its end is "quit", too), each line of standard output the state as JSON; FOLDER/preview.jpg is the newest picture with
// the board and the parts already covered drawn in, replaced as a whole. Test: tests/tracker/guide_test.sh, tests/browser/laboratory.test.ts.

#include <string>

namespace filum {

struct GuideOptions {
  std::string source = "0";  // number of a camera, a video, or pictures named like view_%03d.png
  std::string folder;        // for the preview and the calibration
  std::string camera;        // name, for people
  double square = 10.0;      // [mm], of the board
};

/// Returns when told to quit. Throws InputError for a source or a folder that cannot be used.
int run_guide(const GuideOptions& options);

}  // namespace filum
