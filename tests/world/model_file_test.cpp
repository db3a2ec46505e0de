#include "world/model_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "base/error.h"

namespace filum {
namespace model_file_test {

class ModelFile : public testing::Test {
 protected:
  ~ModelFile() override { std::filesystem::remove(path_); }
  YamlNode open(const std::string& text) {
    std::ofstream(path_) << "format: filum-test/1\n" << text << "\n";
    return open_model_file(path_, "filum-test/1");
  }
  /// The field an InputError names, or what else came out.
  template <typename Read>
  std::string refused(const Read& read) {
    try {
      read();
    } catch (const InputError& e) {
      return e.field;
    }
    return "not refused";
  }
  const std::string path_ = testing::TempDir() + "model_file_test_" + std::to_string(getpid()) + ".yaml";  // tests run side by side
};

TEST_F(ModelFile, FormatIsDemanded) {
  open("a: 1");
  EXPECT_EQ(refused([&] { open_model_file(path_, "filum-other/1"); }), "format");
}

TEST_F(ModelFile, MeasuredQuantityComesInSi) {
  const YamlNode f = open("d: { value: \"23 um\", uncertainty: \"2 um\", source: \"a table\" }");
  EXPECT_NEAR(measured(f, "d", "um", Range::positive()), 23e-6, 1e-18);
}

TEST_F(ModelFile, MeasuredWithoutUncertaintySourceOrUnitIsRefused) {
  const auto field = [&](const std::string& text) {
    const YamlNode f = open("d: " + text);
    return refused([&] { measured(f, "d", "um", Range::positive()); });
  };
  EXPECT_EQ(field("{ value: \"23 um\", source: \"a table\" }"), "d.uncertainty");
  EXPECT_EQ(field("{ value: \"23 um\", uncertainty: \"2 um\" }"), "d.source");
  EXPECT_EQ(field("{ value: \"23 um\", uncertainty: \"2 um\", source: \"\" }"), "d.source");
  EXPECT_EQ(field("{ value: \"23 mN\", uncertainty: \"2 um\", source: \"a table\" }"), "d.value");
  EXPECT_EQ(field("{ value: \"-23 um\", uncertainty: \"2 um\", source: \"a table\" }"), "d.value");
}

TEST_F(ModelFile, APointBeyondAMetreIsRefusedWithItsCoordinates) {
  const YamlNode f = open("a: [\"1 mm\", \"-2 mm\", \"0.3 m\"]\nb: [\"1 mm\", \"2 km\", \"0 mm\"]");
  EXPECT_LT((read_point(f, "a") - Vec3(1e-3, -2e-3, 0.3)).norm(), 1e-15);
  try {
    read_point(f, "b");
    FAIL() << "accepted";
  } catch (const InputError& e) {
    EXPECT_EQ(e.field, "b");
    EXPECT_EQ(e.value, "[\"1 mm\", \"2 km\", \"0 mm\"]");
    EXPECT_EQ(e.expected, "a point within 1000 mm of the origin");
  }
}

TEST_F(ModelFile, DirectionIsOfLengthOneAndNotZero) {
  const YamlNode f = open("a: [0, 3, 4]\nb: [0, 0, 0]");
  EXPECT_LT((read_direction(f, "a") - Vec3(0, 0.6, 0.8)).norm(), 1e-15);
  EXPECT_EQ(refused([&] { read_direction(f, "b"); }), "b");
}

TEST_F(ModelFile, PoseIsARotationWithTheHandleAlongZ) {
  const YamlNode f = open("a: { p: [\"1 mm\", \"2 mm\", \"3 mm\"], handle: [0, 1, 1], opening: [1, 1, 0] }\nb: { p: [\"0 mm\", \"0 mm\", \"0 mm\"], handle: [0, 1, 0], opening: [0, 2, 0] }");
  const Pose X = read_pose(f.map("a"));
  EXPECT_LT((X.p - Vec3(1e-3, 2e-3, 3e-3)).norm(), 1e-15);
  EXPECT_LT((X.q * Vec3::UnitZ() - Vec3(0, 1, 1).normalized()).norm(), 1e-12);
  EXPECT_NEAR(X.q.norm(), 1.0, 1e-12);
  EXPECT_GT((X.q * Vec3::UnitX()).dot(Vec3(1, 1, 0)), 0.0);
  EXPECT_EQ(refused([&] { read_pose(f.map("b")); }), "b.opening");
}

}  // namespace model_file_test
}  // namespace filum
