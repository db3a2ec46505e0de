#include "anatomy/nifti_volume.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <functional>

#include "anatomy/scans.h"
#include "base/error.h"

namespace filum {
namespace nifti_volume_test {

namespace fs = std::filesystem;

std::string temporary(const std::string& name) { return (fs::path(testing::TempDir()) / name).string(); }

TEST(NiftiVolume, AScanMadeByHandIsReadWithItsPlaceAndScale) {
  nifti_1_header h = scans::header(4, 2.0f);
  h.scl_slope = 0.5f;
  h.scl_inter = 3.0f;
  std::vector<unsigned char> voxels(64);
  for (std::size_t k = 0; k < voxels.size(); ++k) voxels[k] = static_cast<unsigned char>(k);
  const std::string path = temporary("small.nii");
  scans::write(path, h, voxels);
  const Volume v = read_nifti(path);
  EXPECT_EQ(v.size, (std::array<int, 3>{4, 4, 4}));
  EXPECT_FLOAT_EQ(v.value[v.index(1, 2, 3)], 0.5f * (1 + 8 + 48) + 3.0f);
  EXPECT_LT((v.place(Vec3(0, 0, 0)) - Vec3::Constant(-3e-3)).norm(), 1e-9);
  EXPECT_LT((v.place(Vec3(3, 0, 0)) - Vec3(3e-3, -3e-3, -3e-3)).norm(), 1e-9);
  EXPECT_NEAR(sample(v, v.value, Vec3(0.5, 0, 0)), 3.25, 1e-6);
  EXPECT_EQ(sample(v, v.value, Vec3(-0.1, 0, 0)), 0.0);
}

TEST(NiftiVolume, WrongHeadersAreRefusedByField) {
  const std::vector<unsigned char> voxels(64, 1);
  const std::string path = temporary("wrong.nii");
  const auto refused = [&](const std::string& field, const std::function<void(nifti_1_header&)>& spoil) {
    nifti_1_header h = scans::header(4, 2.0f);
    spoil(h);
    scans::write(path, h, voxels);
    try {
      read_nifti(path);
      ADD_FAILURE() << field << " was taken";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(field), std::string::npos) << error.what();
    }
  };
  refused("dim[0]", [](nifti_1_header& h) { h.dim[0] = 2; });
  refused("dim[2]", [](nifti_1_header& h) { h.dim[2] = -5; });
  refused("dim[4]", [](nifti_1_header& h) { h.dim[0] = 4, h.dim[4] = 7; });
  refused("pixdim[3]", [](nifti_1_header& h) { h.pixdim[3] = 0.0f; });
  refused("pixdim[1]", [](nifti_1_header& h) { h.pixdim[1] = std::nanf(""); });
  refused("datatype", [](nifti_1_header& h) { h.datatype = 128; });  // colours
  refused("bitpix", [](nifti_1_header& h) { h.bitpix = 16; });
  refused("magic", [](nifti_1_header& h) { std::memcpy(h.magic, "abc", 4); });
  refused("sizeof_hdr", [](nifti_1_header& h) { h.sizeof_hdr = 340; });
  refused("data", [](nifti_1_header& h) { h.dim[1] = h.dim[2] = h.dim[3] = 8; });
  refused("srow_x", [](nifti_1_header& h) { std::memset(h.srow_x, 0, sizeof h.srow_x); });
}

TEST(NiftiVolume, NoFileAndNoHeaderAreRefused) {
  EXPECT_THROW(read_nifti(temporary("none.nii")), InputError);
  const std::string path = temporary("short.nii");
  std::ofstream(path) << "not a scan";
  EXPECT_THROW(read_nifti(path), InputError);
}

}  // namespace nifti_volume_test
}  // namespace filum
