#include "base/markup.h"

#include <gtest/gtest.h>

namespace filum {
namespace markup_test {

TEST(Markup, TextCannotOpenATagOrEndAnAttribute) {
  EXPECT_EQ(escaped("a < b & \"c\" > d"), "a &lt; b &amp; &quot;c&quot; &gt; d");
  EXPECT_EQ(escaped("&lt;"), "&amp;lt;") << "once is not twice";
  EXPECT_EQ(escaped("0.5 mN"), "0.5 mN");
}

}  // namespace markup_test
}  // namespace filum
