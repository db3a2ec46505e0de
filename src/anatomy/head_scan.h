#pragma once
// What of a head scan is brain, and which of it is white matter.
//   Brain extraction   threshold between dark and bright (Otsu, IEEE Trans. SMC 9:62, 1979), worn away until scalp and brain part, the
//                      largest piece, grown back within the threshold. Rough: nerves, sinuses and bits of dura may stay. A scan
//                      that holds nothing but the brain (`extracted`) is taken as it is.
//   Tissue classes     three means of the values in the brain: fluid, grey, white (Lloyd, IEEE Trans. Inf. Theory 28:129, 1982), for
//                      a T1-weighted scan, where white is brightest.
//   Smoothing          Gauss of `smooth`, surface where half is brain; sulci narrower than twice that close.
// Test: head_scan_test.

#include "anatomy/nifti_volume.h"

namespace filum {

struct ScanOptions {
  bool extracted = false;
  double wear = 5e-3;    // [m], by which scalp and brain are parted
  double smooth = 1.5e-3;  // [m]
};

struct BrainScan {
  Volume grid;                      // of the scan; its values are not kept
  std::vector<float> brain, white;  // smoothed shares, 0 to 1
  double threshold = 0.0;           // of the scan's values
  std::array<double, 3> means{};    // fluid, grey, white
  double volume = 0.0;              // [m3], of the brain
  Vec3 middle = Vec3::Zero();       // [m], of the brain, scanner
};

/// Throws InputError (naming `file`) where no brain of 0.1 to 2.2 litres is found.
BrainScan find_brain(Volume scan, const ScanOptions& options, const std::string& file);

/// Otsu's threshold.
double otsu(const std::vector<float>& value);

}  // namespace filum
