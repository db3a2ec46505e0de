#include "tracker/camera_guide.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "tests/tracker/board_views.h"

namespace filum {
namespace camera_guide_test {

/// Shows the board at rest, six pictures a second.
class Shown {
 public:
  CameraGuide guide{ChessBoard{}};
  int show(const Pose& X, int pictures = 3) {
    int taken = 0;
    const cv::Mat picture = picture_of_board(small_camera(), X, 0.5, random_);
    for (int k = 0; k < pictures; ++k) taken += look(picture) ? 1 : 0;
    return taken;
  }
  bool look(const cv::Mat& grey) { return guide.look(grey, 0.16 * n_++); }

 private:
  cv::RNG random_{11};
  int n_ = 0;
};

TEST(CameraGuide, LeadsToACalibrationThatFindsTheCamera) {
  Shown s;
  EXPECT_EQ(s.guide.instruction(), "Show the whole board to the camera");
  for (const Pose& X : whole_tour(small_camera())) {
    EXPECT_FALSE(s.guide.complete());
    s.show(X);
  }
  for (const CameraGuide::Wish& w : s.guide.wishes()) EXPECT_TRUE(w.granted) << w.what;
  EXPECT_TRUE(s.guide.complete());
  EXPECT_EQ(s.guide.instruction(), "Everything was shown: calibrate now");
  const CameraModel c = s.guide.calibrate(), truth = small_camera();
  std::printf("%d views, residual %.3f px, focal length %.1f +- %.1f px of 667, centre off by %.1f %.1f px, %.0f %% covered\n", c.views, c.residual, c.fx, c.uncertainty[0],
              c.cx - truth.cx, c.cy - truth.cy, 100.0 * c.coverage);
  EXPECT_NEAR(c.fx, truth.fx, 4.0);
  EXPECT_NEAR(c.cx, truth.cx, 4.0);
  EXPECT_NEAR(c.cy, truth.cy, 4.0);
  EXPECT_LT(c.residual, 0.3);
  EXPECT_GT(c.coverage, 0.7);
  for (int i = 0; i < 4; ++i) EXPECT_GT(c.uncertainty[static_cast<std::size_t>(i)], 0.0);
  EXPECT_LT(std::abs(c.fx - truth.fx), 5.0 * c.uncertainty[0] + 0.5) << "the uncertainty is of the right size";
  const CameraModel again = CameraModel::parse(c.text(), "camera.yaml");
  EXPECT_NEAR(again.coverage, c.coverage, 1e-3);
  EXPECT_NEAR(again.uncertainty[1], c.uncertainty[1], 1e-3 * c.uncertainty[1]);
}

TEST(CameraGuide, TakesAViewOnlyOfABoardAtRestAndOnlyOnce) {
  Shown s;
  const CameraModel c = small_camera();
  for (int k = 0; k < 8; ++k) s.show(board_at(c, 200.0 + 12.0 * k, 200.0, 0.2, 0.0, 0.0), 1);
  EXPECT_TRUE(s.guide.views().empty()) << "it moves";
  EXPECT_EQ(s.show(board_at(c, 330.0, 200.0, 0.2, 0.0, 0.0), 5), 1) << "the same thing again is nothing new";
  s.guide.undo();
  EXPECT_TRUE(s.guide.views().empty());
  EXPECT_EQ(s.show(board_at(c, 330.0, 200.0, 0.2, 0.0, 0.0), 3), 1) << "taken back, it is wanted again";
  EXPECT_FALSE(s.look(cv::Mat(c.height, c.width, CV_8U, cv::Scalar(120))));
  EXPECT_FALSE(s.guide.now().has_value());
  EXPECT_THROW(s.look(cv::Mat(100, 100, CV_8U, cv::Scalar(120))), InputError) << "another size";
}

TEST(CameraGuide, SaysWhatIsMissingInsteadOfCalibrating) {
  Shown s;
  const CameraModel c = small_camera();
  const auto why = [&] {
    try {
      s.guide.calibrate();
    } catch (const InputError& error) {
      return error.value;
    }
    return std::string("calibrated");
  };
  const std::vector<Pose> tour = whole_tour(c);
  for (std::size_t k = 0; k < 2; ++k) s.show(tour[k]);
  EXPECT_NE(why().find("of 9 parts"), std::string::npos) << why();
  for (std::size_t k = 2; k < 9; ++k) s.show(tour[k]);
  EXPECT_NE(why().find("of 4 sides"), std::string::npos) << why();
}

TEST(CameraGuide, TiltsAreToldFromTheBoardsSides) {
  const CameraModel c = small_camera();
  cv::RNG random(3);
  const auto sight = [&](double about_x, double about_y) {
    return sight_of(find_board(picture_of_board(c, board_at(c, 320, 200, 0.2, about_x, about_y), 0.5, random), {}), {}, {c.width, c.height});
  };
  for (const double tilt : {0.3, 0.5}) {
    EXPECT_NEAR(std::abs(sight(0.0, tilt).tilt_x), tilt, 0.12);
    EXPECT_NEAR(std::abs(sight(tilt, 0.0).tilt_y), tilt, 0.12);
    EXPECT_LT(sight(0.0, tilt).tilt_x * sight(0.0, -tilt).tilt_x, 0.0);
    EXPECT_NEAR(sight(0.0, tilt).tilt_y, 0.0, 0.05);
  }
}

}  // namespace camera_guide_test
}  // namespace filum
