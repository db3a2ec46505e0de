// Points of rendered films against the motion they were rendered with, in the middle of lossless and of compressed pictures.

#include "video/tracks.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "base/error.h"
#include "rendered.h"

namespace filum {
namespace tracks_test {

class Tracks : public ::testing::Test {
 protected:
  Tracks() {
    std::string name = (std::filesystem::temp_directory_path() / "video-XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
  }
  ~Tracks() override { std::filesystem::remove_all(folder_); }
  std::string file(const std::string& name) const { return folder_ + "/" + name; }
  std::string folder_;
};

std::array<double, 2> motion(int k) { return {0.37 * k + 2.0 * std::sin(0.3 * k), 0.11 * k * std::cos(0.2 * k)}; }

struct Errors {
  double rms = 0.0, normalised = 0.0;  // [px]; mean of e^T C^-1 e, 2 where the covariance is right
};

Errors errors_of(const VideoTracks& v, const std::vector<Eigen::Vector2d>& points) {
  Errors e;
  int n = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
    for (Eigen::Index k = 1; k < v.time.size(); ++k) {
      const auto m = motion(static_cast<int>(k));
      const Eigen::Vector2d miss = v.points[i].position.col(k) - points[i] - Eigen::Vector2d(m[0], m[1]);
      Eigen::Matrix2d C;
      C << v.points[i].covariance(0, k), v.points[i].covariance(1, k), v.points[i].covariance(1, k), v.points[i].covariance(2, k);
      e.rms += miss.squaredNorm();
      e.normalised += miss.dot(C.inverse() * miss);
      ++n;
    }
  e.rms = std::sqrt(e.rms / (2.0 * n));
  e.normalised /= n;
  return e;
}

const std::vector<Eigen::Vector2d> kPoints = {{40, 40}, {61, 75}, {90, 52}};

Origin moved() {
  return [](double x, double y, int k) { const auto m = motion(k); return std::array{x - m[0], y - m[1]}; };
}

TEST_F(Tracks, FollowsATextureToHundredthsOfAPixel) {
  ASSERT_TRUE(render(file("a.avi"), 50, 140, 130, 0.0, Waves(1), moved(), 1)) << "this OpenCV writes no FFV1";
  const VideoTracks v = track_video({file("a.avi"), kPoints, 21});
  ASSERT_EQ(v.time.size(), 50);
  EXPECT_NEAR(v.time[49], 49 / 25.0, 1e-9);
  const Errors e = errors_of(v, kPoints);
  EXPECT_LT(e.rms, 0.02);
  std::printf("without noise: rms error %.4f px\n", e.rms);
}

TEST_F(Tracks, CovarianceIsThatOfTheErrorsInNoise) {
  for (const double noise : {3.0, 8.0}) {
    ASSERT_TRUE(render(file("a.avi"), 60, 140, 130, noise, Waves(2), moved(), 2));
    const Errors e = errors_of(track_video({file("a.avi"), kPoints, 21}), kPoints);
    EXPECT_GT(e.normalised, 0.8) << noise;
    EXPECT_LT(e.normalised, 4.0) << noise;
    std::printf("noise %.0f of 128 levels: rms error %.4f px, e^T C^-1 e = %.2f (2 is right)\n", noise, e.rms, e.normalised);
  }
}

TEST_F(Tracks, FollowsACompressedFilm) {
  ASSERT_TRUE(render(file("a.mp4"), 50, 140, 130, 2.0, Waves(3), moved(), 3, "mp4v"));
  const Errors e = errors_of(track_video({file("a.mp4"), kPoints, 21}), kPoints);
  EXPECT_LT(e.rms, 0.15);
  std::printf("MPEG-4: rms error %.4f px\n", e.rms);
}

TEST_F(Tracks, TakesAPatternThatTurnsAnewAndSaysSo) {
  // a turn about the point itself by 0.24 rad in 60 frames: the point rests, its pattern does not (a match without turning drifts, the limit of the method)
  const Origin turned = [](double x, double y, int k) {
    const double a = 0.004 * k, dx = x - 60, dy = y - 60;
    return std::array{60 + std::cos(a) * dx + std::sin(a) * dy, 60 - std::sin(a) * dx + std::cos(a) * dy};
  };
  ASSERT_TRUE(render(file("a.avi"), 60, 121, 121, 1.0, Waves(4), turned, 4));
  const VideoTracks v = track_video({file("a.avi"), {{60, 60}}, 21});
  EXPECT_GT(v.points[0].restarts, 0);
  EXPECT_LT((v.points[0].position.col(59) - Eigen::Vector2d(60, 60)).norm(), 0.8);
  EXPECT_GT(v.points[0].covariance(0, 59), v.points[0].covariance(0, 1));
}

/// A platen's pattern that comes down by `way` px and vanishes behind an edge at y = 60; what lies below rests.
Origin behind_an_edge(double way) {
  return [way](double x, double y, int k) { return std::array{x, y < 60 ? y - way * std::min(k / 25.0, 1.0) : y}; };
}

TEST_F(Tracks, FollowsWhatRestsBesideWhatMovesAndWhatIsHalfCovered) {
  // seeds 50 to 52: coarse levels of the pyramid took the first one's resting point along; the edge comes to the middle of the moving one's square
  double worst = 0.0;
  for (const std::uint64_t seed : {50u, 51u, 52u}) {
    ASSERT_TRUE(render(file("a.avi"), 40, 100, 140, 1.5, Waves(seed), behind_an_edge(30.0), seed));
    const VideoTracks v = track_video({file("a.avi"), {{50, 30}, {50, 110}}, 21});
    EXPECT_EQ(v.points[0].restarts + v.points[1].restarts, 0) << seed;
    EXPECT_GT(v.points[0].covered, 15) << seed;
    EXPECT_EQ(v.points[1].covered, 0) << seed;
    for (int k = 1; k < 40; ++k) {
      worst = std::max(worst, (v.points[0].position.col(k) - Eigen::Vector2d(50, 30 + 30 * std::min(k / 25.0, 1.0))).norm());
      worst = std::max(worst, (v.points[1].position.col(k) - Eigen::Vector2d(50, 110)).norm());
    }
  }
  std::printf("half covered and at rest: at most %.3f px off\n", worst);
  EXPECT_LT(worst, 0.1);
}

TEST_F(Tracks, LosesWhatIsCoveredRatherThanTakeTheCover) {
  ASSERT_TRUE(render(file("a.avi"), 40, 100, 140, 1.5, Waves(50), behind_an_edge(45.0), 50));
  const VideoTracks v = track_video({file("a.avi"), {{50, 30}}, 21});
  EXPECT_EQ(v.points[0].lost, "something came over it");
  EXPECT_FALSE(v.points[0].position.col(30).allFinite());
  for (int k = 1; k < 40 && v.points[0].position.col(k).allFinite(); ++k) EXPECT_NEAR(v.points[0].position(1, k), 30 + 45 * std::min(k / 25.0, 1.0), 0.1) << k;
}

TEST_F(Tracks, RefusesWhatIsNoVideoAndPointsWithoutPattern) {
  EXPECT_THROW(track_video({file("none.avi"), kPoints, 21}), InputError);
  Waves flat(5);
  for (auto& w : flat.wave) w[3] = 0.0;
  ASSERT_TRUE(render(file("flat.avi"), 6, 140, 130, 0.0, flat, moved(), 5));
  try {
    track_video({file("flat.avi"), kPoints, 21});
    FAIL() << "a blank picture was followed";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("texture"), std::string::npos) << e.what();
  }
  ASSERT_TRUE(render(file("a.avi"), 6, 140, 130, 0.0, Waves(6), moved(), 6));
  EXPECT_THROW(track_video({file("a.avi"), {{3, 3}}, 21}), InputError);
}

}  // namespace tracks_test
}  // namespace filum
