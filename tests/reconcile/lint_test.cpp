// What the inputs alone say of the effects of a rig: some they hide altogether, others only lack a condition and stay as rivals.

#include "reconcile/lint.h"

#include <gtest/gtest.h>

#include "reconcile/report.h"
#include "records.h"

namespace filum::reconcile {
namespace lint_test {

/// Of a block pressed at one rate, n samples over 20 s.
std::vector<NotTestable> lint_of_block(int n, const std::string& trials) {
  Folder f;
  f.write("experiment.yaml", block_yaml(trials));
  f.write("a.csv", block_csv([](double, double u, int) { return 10.0 * u; }, 1.0, n));
  const Dataset d = load_dataset(f.path(), FILUM_SOURCE_DIR);
  const auto model = make_model(d);
  const Rules rules;
  return lint(*model, model->all_forms(), rules.lint).not_testable;
}

const NotTestable* find(const std::vector<NotTestable>& all, Effect e) {
  for (const NotTestable& n : all)
    if (n.effect == e) return &n;
  return nullptr;
}

const std::string kCompression = "  - { file: a.csv, protocol: { mode: compression, rate: \"1 mm/s\" } }\n";

TEST(Lint, WhatLacksAConditionStaysAsARival) {
  const auto all = lint_of_block(200, kCompression);
  for (const Effect e : {Effect::poroelastic_drainage, Effect::platen_friction, Effect::tension_compression_asymmetry}) {
    ASSERT_NE(find(all, e), nullptr) << info(e).name;
    EXPECT_FALSE(find(all, e)->hidden) << info(e).name;
    EXPECT_FALSE(find(all, e)->why.empty());
    EXPECT_FALSE(find(all, e)->needs.empty());
  }
  EXPECT_EQ(find(all, Effect::viscoelastic_relaxation), nullptr) << "twenty seconds with a hold show it";
}

TEST(Lint, WhatTheInputsHideCannotBeNamed) {
  const auto coarse = lint_of_block(15, kCompression);  // less than one a second
  for (const Effect e : {Effect::pulsation, Effect::mains_hum}) {
    ASSERT_NE(find(coarse, e), nullptr) << info(e).name;
    EXPECT_TRUE(find(coarse, e)->hidden) << find(coarse, e)->why;
  }
  EXPECT_EQ(find(lint_of_block(200, kCompression), Effect::pulsation), nullptr);
  // the same record in a series load train is a softer block: no record of one specimen tells compliance
  const auto all = lint_of_block(200, kCompression);
  ASSERT_NE(find(all, Effect::rig_compliance), nullptr);
  EXPECT_TRUE(find(all, Effect::rig_compliance)->hidden) << find(all, Effect::rig_compliance)->why;
}

}  // namespace lint_test
}  // namespace filum::reconcile
