#include "tracker/camera_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/error.h"
#include "tests/tracker/board_views.h"

namespace filum {
namespace camera_model_test {

std::vector<cv::Mat> views(double tilt) {
  std::vector<cv::Mat> pictures;
  cv::RNG random(5);
  for (int k = 0; k < 12; ++k) {
    const double turn = 2.0 * std::numbers::pi * k / 12.0;
    Pose X;
    X.p = Vec3(0.02 * std::cos(3.0 * turn), 0.01 * std::sin(2.0 * turn), 0.22 + 0.02 * std::sin(turn));
    X.q = Quat(Eigen::AngleAxisd(tilt, Vec3(std::cos(turn), std::sin(turn), 0))) * Quat(Eigen::AngleAxisd(std::numbers::pi, Vec3::UnitX()));
    cv::Mat big = blank2x(plain_camera());
    draw(plain_camera(), board_picture(), 0.12, 0.09, X, big);
    pictures.push_back(developed(big, 0.7, 1.5, random));
  }
  return pictures;
}

TEST(CameraModel, CalibrationFindsTheCameraThatTookThePictures) {
  const CameraModel c = calibrate_camera(views(0.5), {});
  EXPECT_NEAR(c.fx, 1000.0, 5.0);
  EXPECT_NEAR(c.fy, 1000.0, 5.0);
  EXPECT_NEAR(c.cx, 480.0, 5.0);
  EXPECT_NEAR(c.cy, 300.0, 5.0);
  EXPECT_LT(c.residual, 0.3);
  std::printf("residual %.3f px, focal length %.1f px of 1000, centre off by %.1f %.1f px\n", c.residual, c.fx, c.cx - 480.0, c.cy - 300.0);
  const CameraModel again = CameraModel::parse(c.text(), "camera.yaml");
  EXPECT_NEAR(again.fx, c.fx, 1e-5);
  EXPECT_NEAR(again.distortion[1], c.distortion[1], 1e-8);
}

TEST(CameraModel, RefusesPicturesThatDoNotSupportIt) {
  EXPECT_THROW(calibrate_camera({}, {}), InputError);
  EXPECT_THROW(calibrate_camera(std::vector<cv::Mat>(10, cv::Mat(120, 160, CV_8U, cv::Scalar(100))), {}), InputError);
  try {
    calibrate_camera(views(0.05), {});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("same side"), std::string::npos) << error.what();
  }
}

TEST(CameraModel, AFileWithNonsenseIsRefused) {
  const std::string good = plain_camera().text();
  EXPECT_NO_THROW(CameraModel::parse(good, "c.yaml"));
  for (const auto& [from, to] : {std::pair{"fx: 1000", "fx: -1"}, {"width: 960", "width: 0"}, {"distortion: [0,", "distortion: [nan,"}}) {
    std::string bad = good;
    const auto at = bad.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    bad.replace(at, std::string(from).size(), to);
    EXPECT_THROW(CameraModel::parse(bad, "c.yaml"), InputError) << to;
  }
}

}  // namespace camera_model_test
}  // namespace filum
