#pragma once
// A scan of a head as numbers in space, read from NIfTI-1 files (.nii, .nii.gz, .hdr/.img) by Debian's libnifti. What the header
// says is checked before anything is read. Test: nifti_volume_test.

#include <array>
#include <string>
#include <vector>

#include "base/pose.h"

namespace filum {

struct Volume {
  std::array<int, 3> size{};
  std::vector<float> value;      // x fastest
  Mat3 step = Mat3::Identity();  // [m], index -> place of the scanner (x right, y front, z up)
  Vec3 first = Vec3::Zero();     // [m], place of voxel 0, 0, 0

  std::size_t index(int i, int j, int k) const noexcept {
    return static_cast<std::size_t>(i) + static_cast<std::size_t>(size[0]) * (static_cast<std::size_t>(j) + static_cast<std::size_t>(size[1]) * static_cast<std::size_t>(k));
  }
  Vec3 place(const Vec3& at) const { return step * at + first; }
};

/// Throws InputError naming the file and the field of the header that is wrong.
Volume read_nifti(const std::string& path);

/// Value between voxels, linear in each direction; 0 outside. `at` in voxels.
double sample(const Volume& v, const std::vector<float>& value, const Vec3& at) noexcept;

}  // namespace filum
