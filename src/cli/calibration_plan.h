#pragma once
// What a guided calibration of the forceps is to ask for, from a page's wish. Test: tests/cli/calibration_plan_test.cpp.

#include <string>
#include <vector>

namespace filum {

struct CalibrationPlan {
  std::string port, root, folder;             // folder: where the file goes
  std::string sensor = "unknown", name = "forceps";
  std::vector<double> angles = {0, 5, 10, 15, 20, 25};       // [deg], growing
  std::vector<double> forces = {0, 0.2, 0.5, 1.0, 2.0, 3.0};  // [N], growing
  int repeats = 2;
  unsigned identity = 1;                      // as it is stored in the handle
};

/// From a page's wish: sensor, name, identity, repeats, angles [deg], forces [N]; what is absent keeps its default. Throws InputError.
CalibrationPlan calibration_plan(const std::string& json, std::string port, std::string root, std::string folder);

}  // namespace filum
