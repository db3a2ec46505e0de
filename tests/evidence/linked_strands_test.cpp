#include "evidence/linked_strands.h"

#include <gtest/gtest.h>

namespace filum {
namespace linked_strands_test {

// A million steps: `filum validate linking-number`.
TEST(LinkedStrands, StayLinkedHoweverTheyAreThrownAbout) {
  LinkedStrands hooks;
  ASSERT_NEAR(hooks.linking(), 1.0, 1e-12);
  int touching = 0;
  for (int k = 0; k < 10000; ++k) {
    ASSERT_TRUE(hooks.advance().sound);
    ASSERT_NEAR(hooks.linking(), 1.0, 1e-9) << "step " << k;
    touching += hooks.touching() ? 1 : 0;
  }
  EXPECT_GT(touching, 5000) << "they must have been thrown against each other";
}

TEST(LinkedStrands, ComeApartWithoutContact) {  // what the test above would see
  LinkedStrands hooks;
  hooks.rod.self_contact = false;
  bool apart = false;
  for (int k = 0; k < 300 && !apart; ++k) {
    hooks.advance();
    apart = std::abs(hooks.linking() - 1.0) > 0.5;
  }
  EXPECT_TRUE(apart);
}

/// The closing lines must stay out of the other hook's reach, or the linking number could change without a passage.
TEST(LinkedStrands, DoNotReachEachOthersClosingLine) {
  LinkedStrands hooks;
  const int each = hooks.state.n / 2;
  for (int k = 0; k < 3000; ++k) {
    hooks.advance();
    const auto z = hooks.state.x.row(2);
    ASSERT_GT(z[0], z.segment(each, each).maxCoeff() + 0.1e-3) << "step " << k;
    ASSERT_LT(z[each], z.head(each).minCoeff() - 0.1e-3) << "step " << k;
  }
}

}  // namespace linked_strands_test
}  // namespace filum
