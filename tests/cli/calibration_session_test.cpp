#include "cli/calibration_session.h"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "devices/forceps_calibration.h"
#include "tests/devices/simulated_handle.h"

namespace filum {
namespace calibration_session_test {

using namespace std::chrono_literals;

CalibrationPlan plan(const Pty& pty, const std::string& folder) {
  CalibrationPlan p = calibration_plan(R"({"sensor":"S-17","identity":42,"repeats":2,"angles":[0,6,12,18,24],"forces":[0,0.5,1,2,3]})", pty.path(), FILUM_SOURCE_DIR, folder);
  return p;
}

/// Sets what is asked for and reads it, until all is taken. True count of an opening is 1000 + 80 a degree, of a load 300 + 900 a newton.
void go_through(CalibrationSession& session, SimulatedHandle& handle, double bend) {
  const std::vector<double> angles = {0, 6, 12, 18, 24, 24, 18, 12, 6, 0}, forces = {0, 0.5, 1, 2, 3, 3, 2, 1, 0.5, 0};
  for (int k = 0; k < 40; ++k) {
    const bool angle = k < 20;
    const double value = (angle ? angles : forces)[static_cast<std::size_t>(k % 10)];
    if (angle) handle.angle = 1000.0 + 80.0 * value + bend * value * value;
    else handle.force = 300.0 + 900.0 * value;
    handle.wait();
    session.read();
    const auto end = std::chrono::steady_clock::now() + 20s;
    while (session.status()["taken"].get<int>() <= k && std::chrono::steady_clock::now() < end) std::this_thread::sleep_for(2ms);
    ASSERT_EQ(session.status()["taken"].get<int>(), k + 1) << session.status().dump();
  }
}

class CalibrationSessionTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (std::filesystem::temp_directory_path() / "filum-calibration-XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::string folder_;
};

TEST_F(CalibrationSessionTest, LeadsThroughAllValuesAndWritesWhatForcepsRead) {
  Pty pty;
  CalibrationSession session(plan(pty, folder_));
  SimulatedHandle handle(pty);
  EXPECT_EQ(session.status()["state"], "asking");
  EXPECT_NE(session.status()["instruction"].get<std::string>().find("0 deg"), std::string::npos);
  handle.wait();
  session.read();
  for (int k = 0; k < 5000 && session.status()["taken"] == 0; ++k) std::this_thread::sleep_for(2ms);
  ASSERT_EQ(session.status()["taken"], 1);
  EXPECT_NEAR(session.status()["live"].get<double>(), 1000.0, 2.0);
  session.undo();  // what was read by mistake is asked for again
  EXPECT_EQ(session.status()["taken"], 0);
  go_through(session, handle, 0.0);
  const auto status = session.status();
  ASSERT_EQ(status["state"], "done") << status.dump();
  const ForcepsCalibration made = ForcepsCalibration::load(session.file());
  EXPECT_NEAR(made.angle(1000 + 80 * 10), 10.0 * M_PI / 180.0, 2e-3);
  EXPECT_EQ(made.identity, 42u);
  EXPECT_EQ(made.sensor, "S-17");
  EXPECT_NEAR(status["fits"]["force"]["gain"].get<double>(), 1.0 / 900.0, 1e-6);
}

TEST_F(CalibrationSessionTest, RefusesACurveWithItsReasonAndWritesNothing) {
  Pty pty;
  CalibrationSession session(plan(pty, folder_));
  SimulatedHandle handle(pty);
  go_through(session, handle, -2.9);  // the strain turns round
  EXPECT_EQ(session.status()["state"], "refused");
  EXPECT_FALSE(session.status()["fits"]["angle"]["why"].get<std::string>().empty());
  EXPECT_TRUE(session.file().empty());
  EXPECT_TRUE(std::filesystem::is_empty(folder_));
}

TEST(CalibrationSession, APortThatIsNotThereIsRefused) {
  EXPECT_THROW(CalibrationSession(calibration_plan("{}", "/dev/no-such-port", FILUM_SOURCE_DIR, "")), InputError);
}

}  // namespace calibration_session_test
}  // namespace filum
