#include "base/units.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"

namespace filum {
namespace units_test {

struct Case {
  const char* text;
  const char* unit;
  double si;
};

class Parse : public testing::TestWithParam<Case> {};

TEST_P(Parse, GivesSi) {
  const Case& c = GetParam();
  EXPECT_NEAR(parse_quantity(c.text, c.unit), c.si, 4e-16 * std::abs(c.si)) << c.text;
}

INSTANTIATE_TEST_SUITE_P(
    Units, Parse,
    testing::Values(
        Case{"0.35 mm", "m", 0.35e-3}, Case{"25 um", "mm", 25e-6}, Case{"25 \xC2\xB5m", "mm", 25e-6},
        Case{"2.5 GPa", "Pa", 2.5e9}, Case{"1140 kg/m3", "kg/m3", 1140}, Case{"1.14 g/cm^3", "kg/m3", 1140},
        Case{"0.2", "-", 0.2}, Case{"0.2 -", "-", 0.2}, Case{"50 %", "-", 0.5},
        Case{"30 deg", "rad", std::acos(-1.0) / 6}, Case{"4.79e-11 N.m2", "N.m2", 4.79e-11},
        Case{"4.79e-5 N*mm^2", "N.m2", 4.79e-11}, Case{"12 mmHg", "Pa", 12 * 133.322387415},
        Case{"10 cmH2O", "Pa", 980.665}, Case{"1 kgf", "N", 9.80665}, Case{"100 gf", "N", 0.980665},
        Case{"37 degC", "K", 310.15}, Case{"2 min", "s", 120}, Case{"1.5 h", "s", 5400},
        Case{"512 count", "count", 512}, Case{"60 1/min", "Hz", 1}, Case{"9.81 m.s-2", "m/s2", 9.81},
        Case{"3.5 kJ/(kg.K)", "J/kg/K", 3500}, Case{"-5 mN", "N", -5e-3}, Case{"+5mN", "N", 5e-3},
        Case{"2 ml/min", "m3/s", 2e-6 / 60}, Case{"10 kV", "V", 1e4}, Case{"4.7 kohm", "ohm", 4700},
        Case{"100 nF", "F", 1e-7}, Case{"1 Pa.s", "N.s/m2", 1}, Case{"3 daN", "N", 30},
        Case{"1 N\xC2\xB7m\xC2\xB2", "N.m2", 1}, Case{"1 kat", "mol/s", 1}, Case{"2 lm/sr", "cd", 2}));

TEST(Units, PrefixedDecimalsAreTheDoubleOneWouldWrite) {
  EXPECT_EQ(parse_quantity("25 um", "m"), 25e-6);
  EXPECT_EQ(parse_quantity("5 mm", "m"), 5e-3);
  EXPECT_EQ(parse_quantity("1 kg", "kg"), 1.0);
  EXPECT_EQ(parse_quantity("3 nm", "m"), 3e-9);
}

class Refuse : public testing::TestWithParam<Case> {};

TEST_P(Refuse, WithTextAndWhatWasExpected) {
  const Case& c = GetParam();
  try {
    parse_quantity(c.text, c.unit, "suture.yaml:3", "diameter");
    FAIL() << c.text << " was taken for " << c.unit;
  } catch (const InputError& error) {
    EXPECT_EQ(error.file, "suture.yaml:3");
    EXPECT_EQ(error.field, "diameter");
    EXPECT_NE(error.value.find(std::string(c.text).substr(0, 10)), std::string::npos);
    const std::string named = std::string(c.unit) == "-" ? "without a unit" : c.unit;
    EXPECT_NE(error.expected.find(named), std::string::npos);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Units, Refuse,
    testing::Values(Case{"25", "mm", 0}, Case{"25 furlong", "mm", 0}, Case{"25 kg", "mm", 0},
                    Case{"mm", "mm", 0}, Case{"", "mm", 0}, Case{"nan mm", "mm", 0}, Case{"inf mm", "mm", 0},
                    Case{"1e400 mm", "mm", 0}, Case{"1e308 km", "mm", 0}, Case{"25 mm mm", "mm", 0},
                    Case{"25 mm/", "mm", 0}, Case{"25 .mm", "mm", 0}, Case{"25 (mm", "mm", 0},
                    Case{"25 mm)", "mm", 0}, Case{"25 m^", "mm", 0}, Case{"25 m99999999999", "mm", 0},
                    Case{"25 mmin", "s", 0}, Case{"0,35 mm", "mm", 0}, Case{"0x10 mm", "mm", 0},
                    Case{"30", "deg", 0}, Case{"30 deg", "-", 0}, Case{"5 count", "-", 0},
                    Case{"5 mdegC", "K", 0}, Case{"5 J/(kg.degC)", "J/kg/K", 0}));

TEST(Units, RefusesVeryLongTextsAndDeepBrackets) {
  EXPECT_THROW(parse_quantity("1 " + std::string(100000, '('), "m"), InputError);
  EXPECT_THROW(parse_quantity("1 " + std::string(60, '(') + "m" + std::string(59, ')'), "m"), InputError);
  EXPECT_EQ(parse_quantity("1 " + std::string(60, '(') + "m" + std::string(60, ')'), "m"), 1.0);
}

TEST(Units, UnknownUnitOfTheCallerIsNamed) {
  EXPECT_THROW(dimension_of("furlong"), InputError);
  EXPECT_THROW(unit_scale("degC"), InputError);
  EXPECT_EQ(unit_scale("mN"), 1e-3);
}

TEST(Units, DimensionsCompareByMeaning) {
  EXPECT_EQ(dimension_of("N.m2"), dimension_of("Pa.m4"));
  EXPECT_EQ(dimension_of("J"), dimension_of("kg.m2/s2"));
  EXPECT_NE(dimension_of("rad/s"), dimension_of("Hz"));
  EXPECT_EQ(unit_text(dimension_of("N.m2")), "m3.kg/s2");
  EXPECT_EQ(unit_text(dimension_of("1/s")), "1/s");
  EXPECT_EQ(unit_text(dimension_of("-")), "-");
}

TEST(Units, FormatsForPeople) {
  EXPECT_EQ(format_quantity(0.35e-3, "mm"), "0.35 mm");
  EXPECT_EQ(format_quantity(0.25, "-"), "0.25");
  EXPECT_EQ(format_quantity(310.15, "degC"), "37 degC");
  EXPECT_EQ(format_quantity(0.123456789, "N", 3), "0.123 N");
  EXPECT_EQ(format_prefixed(3.5e-4, "m"), "350 um");
  EXPECT_EQ(format_prefixed(-0.0123, "N"), "-12.3 mN");
  EXPECT_EQ(format_prefixed(2.5e9, "Pa"), "2.5 GPa");
  EXPECT_EQ(format_prefixed(0.0, "N"), "0 N");
  EXPECT_EQ(format_prefixed(9.99999e-4, "m", 4), "1 mm");
  EXPECT_EQ(format_prefixed(1000.0, "N"), "1 kN");
}

}  // namespace units_test
}  // namespace filum
