#include "cli/calibration_plan.h"

#include <gtest/gtest.h>

#include "tests/refusal.h"

namespace filum {
namespace calibration_plan_test {

CalibrationPlan taken(const std::string& wish) { return calibration_plan(wish, "/dev/ttyACM0", "root", "folder"); }

/// What is said of a wish; an empty field if it is taken.
InputError refusal(const std::string& wish) { return refusal_by([&] { taken(wish); }); }

std::string with(const std::string& key, const std::string& value) { return "{\"" + key + "\":" + value + "}"; }

/// Refused with all that a page needs to say what is wrong.
void expect_refused(const std::string& key, const std::string& value, const std::string& expected) {
  const InputError error = refusal(with(key, value));
  EXPECT_EQ(error.file, "calibration") << value;
  EXPECT_EQ(error.field, key) << value;
  EXPECT_EQ(error.value, value);
  EXPECT_NE(error.expected.find(expected), std::string::npos) << error.what();
}

/// "[0,1,2,...]" with so many numbers, `step` apart.
std::string row(int n, double first, double step) {
  std::string all = "[";
  for (int k = 0; k < n; ++k) all += (k > 0 ? "," : "") + std::to_string(first + step * k);
  return all + "]";
}

TEST(CalibrationPlan, WhatIsAbsentKeepsItsDefault) {
  const CalibrationPlan plan = taken("{}"), usual;
  EXPECT_EQ(plan.port, "/dev/ttyACM0");
  EXPECT_EQ(plan.root, "root");
  EXPECT_EQ(plan.folder, "folder");
  EXPECT_EQ(plan.sensor, usual.sensor);
  EXPECT_EQ(plan.name, usual.name);
  EXPECT_EQ(plan.angles, usual.angles);
  EXPECT_EQ(plan.forces, usual.forces);
  EXPECT_EQ(plan.repeats, 2);
  EXPECT_EQ(plan.identity, 1u);
}

TEST(CalibrationPlan, WhatIsWishedIsTakenInDegreesAndNewtons) {
  const CalibrationPlan plan = taken(R"({"sensor":"S-17_b.2","name":"left","identity":42,"repeats":3,"angles":[-6,0,6.5,12,18],"forces":[0,0.5,1,2,3]})");
  EXPECT_EQ(plan.sensor, "S-17_b.2");
  EXPECT_EQ(plan.name, "left");
  EXPECT_EQ(plan.identity, 42u);
  EXPECT_EQ(plan.repeats, 3);
  EXPECT_EQ(plan.angles, (std::vector<double>{-6, 0, 6.5, 12, 18}));
  EXPECT_EQ(plan.forces, (std::vector<double>{0, 0.5, 1, 2, 3}));
}

TEST(CalibrationPlan, ThePlacesOfTheFilesAreNotThePagesToChoose) {
  const CalibrationPlan plan = taken(R"({"port":"/etc/passwd","root":"/","folder":"/tmp"})");
  EXPECT_EQ(plan.port, "/dev/ttyACM0");
  EXPECT_EQ(plan.root, "root");
  EXPECT_EQ(plan.folder, "folder");
}

TEST(CalibrationPlan, FiveToTwentyGrowingNumbersAreTaken) {
  for (const int n : {5, 20}) {
    EXPECT_EQ(taken(with("angles", row(n, 0.0, 1.0))).angles.size(), static_cast<std::size_t>(n));
    EXPECT_EQ(taken(with("forces", row(n, 0.0, 0.25))).forces.size(), static_cast<std::size_t>(n));
  }
  for (const char* key : {"angles", "forces"}) {
    for (const int n : {0, 4, 21}) EXPECT_EQ(refusal(with(key, row(n, 0.0, 0.1))).field, key) << n;
    for (const char* list : {"[0,1,2,3,3]", "[0,1,2,3,2.9]", "[4,3,2,1,0]", "[0,1,2,3,\"4\"]", "[0,1,2,3,null]", "5", "\"0 1 2 3 4\"", "{\"a\":1}", "null"})
      expect_refused(key, list, "5 to 20 growing numbers");
  }
}

TEST(CalibrationPlan, AnglesReachSixtyDegreesAndForcesTwentyNewtons) {
  EXPECT_EQ(taken(with("angles", "[-60,-30,0,30,60]")).angles.front(), -60.0);
  EXPECT_EQ(taken(with("angles", "[-60,-30,0,30,60]")).angles.back(), 60.0);
  EXPECT_EQ(taken(with("forces", "[-20,-10,0,10,20]")).forces.back(), 20.0);
  expect_refused("angles", "[0,1,2,3,60.001]", "from -60.000000 to 60.000000");
  expect_refused("angles", "[-60.001,1,2,3,4]", "from -60.000000 to 60.000000");
  expect_refused("forces", "[0,1,2,3,20.001]", "from -20.000000 to 20.000000");
  expect_refused("forces", "[-20.001,1,2,3,4]", "from -20.000000 to 20.000000");
}

TEST(CalibrationPlan, RepeatsAreTwoToTwenty) {
  EXPECT_EQ(taken(with("repeats", "2")).repeats, 2);
  EXPECT_EQ(taken(with("repeats", "20")).repeats, 20);
  for (const char* bad : {"0", "1", "21", "-2", "2.5", "\"3\"", "true", "null", "18446744073709551615"}) expect_refused("repeats", bad, "a whole number from 2 to 20");
}

TEST(CalibrationPlan, AnIdentityIsAPositiveNumberThatTheHandleCanKeep) {
  EXPECT_EQ(taken(with("identity", "1")).identity, 1u);
  EXPECT_EQ(taken(with("identity", "2147483647")).identity, 2147483647u);
  for (const char* bad : {"0", "-1", "2147483648", "18446744073709551615", "1.5", "\"7\"", "null"}) expect_refused("identity", bad, "a whole number from 1 to 2147483647");
}

TEST(CalibrationPlan, NamesAreOfAFewPlainLetters) {
  const std::string longest(40, 'a');
  for (const char* key : {"sensor", "name"}) {
    EXPECT_EQ(refusal(with(key, "\"" + longest + "\"")).value, "taken") << key;
    expect_refused(key, "\"" + longest + "a\"", "up to 40 letters");
    for (const char* bad : {"\"\"", "\"../x\"", "\"a b\"", "\"a/b\"", "\"\xc3\xa4\"", "\"a\\nb\"", "7", "null", "[\"a\"]"}) expect_refused(key, bad, "up to 40 letters");
  }
}

TEST(CalibrationPlan, WhatIsNoObjectIsShownInPart) {
  for (const char* wish : {"nothing", "[]", "7", "", "{\"repeats\":2", "{\"forces\":[0,1,2,3,1e999]}"}) {
    const InputError error = refusal(wish);
    EXPECT_EQ(error.file, "calibration") << wish;
    EXPECT_EQ(error.field, "body") << wish;
    EXPECT_EQ(error.value, wish);
    EXPECT_EQ(error.expected, "a JSON object");
  }
  EXPECT_EQ(refusal(std::string(1000, 'x')).value, std::string(80, 'x'));
}

}  // namespace calibration_plan_test
}  // namespace filum
