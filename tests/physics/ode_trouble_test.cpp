#include "physics/ode_trouble.h"

#include <gtest/gtest.h>
#include <ode/ode.h>

namespace filum {
namespace ode_trouble_test {

TEST(OdeTrouble, MessagesAreCountedAndNotPrinted) {
  listen_to_ode();
  const long before = ode_troubles();
  testing::internal::CaptureStderr();
  dMessage(3, "LCP internal error, s <= 0 (s=%.4e)", -1.0);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(ode_troubles() - before, 1);
}

}  // namespace ode_trouble_test
}  // namespace filum
