// Bounds of the shipped needles: model_bounds_test.

#include "world/needle_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "base/error.h"
#include "world/needle_model.h"

namespace filum {
namespace needle_file_test {

namespace fs = std::filesystem;

class NeedleFile : public ::testing::Test {
 protected:
  NeedleFile() {
    std::string name = (fs::temp_directory_path() / "needle-XXXXXX").string();
    root_ = ::mkdtemp(name.data());
    fs::create_directories(root_ / "models/needle");
  }
  ~NeedleFile() override { fs::remove_all(root_); }
  std::string path() const { return (root_ / "models/needle/mine.yaml").string(); }
  /// A half circle of 75 um wire, with these instead of its own taper and width of flats.
  void write(const std::string& taper = "0.4 mm", const std::string& flat_width = "30 um", const std::string& more = "") {
    std::ofstream(path()) << "format: filum-needle/1\ntitle: Mine\n" << quantity("wire", "75 um") << quantity("circle", "0.5") << quantity("length", "3.8 mm") << quantity("density", "7900 kg/m3")
                          << quantity("taper", taper) << quantity("flat_width", flat_width) << quantity("pad_friction", "0.3") << quantity("sheet_friction", "0.4")
                          << quantity("grip_stiffness", "3000 N/m") << more;
  }
  static std::string quantity(const std::string& key, const std::string& value) {
    const std::size_t unit = value.find(' ');
    return key + ": { value: \"" + value + "\", uncertainty: \"0" + (unit == std::string::npos ? "" : value.substr(unit)) + "\", source: test }\n";
  }
  /// Field that the error names; empty if there is none.
  std::string refused() const {
    try {
      load_needle(path());
    } catch (const InputError& e) {
      return e.field;
    }
    return "";
  }
  fs::path root_;
};

TEST_F(NeedleFile, GivesTheWiresRadiusAndTheBendThatItsLengthAsksFor) {
  write();
  const NeedleShape n = load_needle(path());
  EXPECT_EQ(n.name, "Mine");
  EXPECT_NEAR(n.wire_radius, 37.5e-6, 1e-15);
  EXPECT_NEAR(n.bend_radius, 3.8e-3 / M_PI, 1e-12);
  EXPECT_NEAR(n.length(), 3.8e-3, 1e-12);
  EXPECT_NEAR(n.taper, 0.4e-3, 1e-12);
  EXPECT_NEAR(n.flat_width, 30e-6, 1e-15);
  EXPECT_EQ(n.circle, 0.5);
  EXPECT_EQ(n.density, 7900.0);
  EXPECT_EQ(n.pad_friction, 0.3);
  EXPECT_EQ(n.sheet_friction, 0.4);
  EXPECT_EQ(n.grip_stiffness, 3000.0);
}

TEST_F(NeedleFile, RefusesWhatNoNeedleCanBe) {
  write("3.9 mm");
  EXPECT_EQ(refused(), "taper.value") << "longer than the needle";
  write("0.4 mm", "76 um");
  EXPECT_EQ(refused(), "flat_width.value") << "wider than the wire";
  write("0.4 mm", "30 um", "colour: blue\n");
  EXPECT_EQ(refused(), "colour");
}

/// The needle goes on where the thread ends, as near to the thread's own direction as its plane allows.
TEST_F(NeedleFile, IsPutWhereTheThreadEndsInThePlaneAskedFor) {
  write();
  Model m;
  m.thread_path.resize(3, 3);
  m.thread_path << 0.0, 1e-3, 2e-3, 0.0, 1e-3, 1e-3, 2e-3, 2e-3, 2.5e-3;  // ends along (2, 0, 1)
  read_needle(root_.string(), YamlNode::parse("{ model: mine, normal: [0, 0, 2] }", "scene.yaml"), m);
  ASSERT_TRUE(m.needle);
  const NeedleShape& n = m.needle->shape;
  const Pose& X = m.needle->start;
  EXPECT_LT((X * n.point(0.0) - Vec3(2e-3, 1e-3, 2.5e-3)).norm(), 1e-15);
  EXPECT_LT((X.q * n.tangent(0.0) - Vec3::UnitX()).norm(), 1e-12);
  EXPECT_LT((X.q * Vec3::UnitZ() - Vec3::UnitZ()).norm(), 1e-12);
  EXPECT_EQ(m.sources, std::vector<std::string>{"models/needle/mine.yaml"});
  EXPECT_TRUE(m.description.needle.present);
}

TEST_F(NeedleFile, ThreadThatStandsUprightOnThePlaneGivesItNoDirection) {
  write();
  Model m;
  m.thread_path.resize(3, 2);
  m.thread_path << 0.0, 0.1e-3, 0.0, 0.0, 0.0, 1e-3;
  EXPECT_THROW(read_needle(root_.string(), YamlNode::parse("{ model: mine, normal: [0, 0, 1] }", "scene.yaml"), m), InputError);
  EXPECT_NO_THROW(read_needle(root_.string(), YamlNode::parse("{ model: mine, normal: [1, 0, 0] }", "scene.yaml"), m));
}

}  // namespace needle_file_test
}  // namespace filum
