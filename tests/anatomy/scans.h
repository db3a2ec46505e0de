#pragma once
// Scans made by hand: a NIfTI-1 file is 348 bytes of header, four of extension, and the voxels.

#include <nifti1.h>

#include <cstring>
#include <fstream>
#include <string>
#include <vector>

namespace filum::scans {

inline nifti_1_header header(int n, float voxel_mm) {
  nifti_1_header h{};
  h.sizeof_hdr = 348;
  h.dim[0] = 3;
  for (int d = 1; d <= 7; ++d) h.dim[d] = static_cast<short>(d <= 3 ? n : 1);
  h.datatype = 2;  // bytes
  h.bitpix = 8;
  h.pixdim[0] = 1.0f;
  for (int d = 1; d <= 3; ++d) h.pixdim[d] = voxel_mm;
  h.vox_offset = 352.0f;
  h.scl_slope = 1.0f;
  h.xyzt_units = 2;
  h.sform_code = 1;
  const float first = -0.5f * voxel_mm * static_cast<float>(n - 1);
  h.srow_x[0] = h.srow_y[1] = h.srow_z[2] = voxel_mm;
  h.srow_x[3] = h.srow_y[3] = h.srow_z[3] = first;
  std::memcpy(h.magic, "n+1", 4);
  return h;
}

inline void write(const std::string& path, const nifti_1_header& h, const std::vector<unsigned char>& voxels) {
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(&h), sizeof h);
  file.write("\0\0\0\0", 4);
  file.write(reinterpret_cast<const char*>(voxels.data()), static_cast<std::streamsize>(voxels.size()));
}

/// A head of n x n x n voxels: a ball of grey 45 mm in radius about white of 30 mm, dark fluid, a bright scalp 60 to 66 mm out.
inline std::vector<unsigned char> ball_head(int n, double voxel_mm) {
  std::vector<unsigned char> v;
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const double c = 0.5 * (n - 1), r = voxel_mm * std::sqrt((i - c) * (i - c) + (j - c) * (j - c) + (k - c) * (k - c));
        v.push_back(r < 5.0 ? 60 : r < 30.0 ? 200 : r < 45.0 ? 130 : r > 60.0 && r < 66.0 ? 220 : 10);
      }
  return v;
}

}  // namespace filum::scans
