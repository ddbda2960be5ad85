#include "html.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "astroid/test/temporary_folder.hpp"

namespace astroid::html {
namespace {

TEST(HtmlEscape, MakesMarkupHarmless) {
  EXPECT_EQ(escape("<script>alert(\"x\" & 'y')</script>"),
            "&lt;script&gt;alert(&quot;x&quot; &amp; &#39;y&#39;)&lt;/script&gt;");
}

TEST(HtmlEscape, KeepsUnicodeAndReplacesWhatIsNone) {
  EXPECT_EQ(escape("α Cen – 5 µm 🔭"), "α Cen – 5 µm 🔭");
  EXPECT_EQ(escape("a\xFF"
                   "b"),
            "a\xEF\xBF\xBD"
            "b");
  EXPECT_EQ(escape("\xC3"), "\xEF\xBF\xBD");                                  // cut off
  EXPECT_EQ(escape("\xC0\xBC"), "\xEF\xBF\xBD\xEF\xBF\xBD");                  // an overlong <
  EXPECT_EQ(escape("\xED\xA0\x80"), "\xEF\xBF\xBD\xEF\xBF\xBD\xEF\xBF\xBD");  // a surrogate
  EXPECT_EQ(escape(std::string("a\0\x1b\n", 4)), "a\xEF\xBF\xBD\xEF\xBF\xBD\n");
}

TEST(HtmlNumber, ShowsSignificantDigits) {
  EXPECT_EQ(number(49.4408, 4), "49.44");
  EXPECT_EQ(number(1234.56, 4), "1235");
  EXPECT_EQ(number(0.00123456, 3), "0.00123");
  EXPECT_EQ(number(1.5e-7, 3), "1.5×10<sup>-7</sup>");
  EXPECT_EQ(number(0.0, 3), "0");
  EXPECT_EQ(number(std::numeric_limits<double>::quiet_NaN(), 3), "–");
  EXPECT_EQ(number(std::numeric_limits<double>::infinity(), 3), "–");
}

TEST(HtmlFixed, NeverShowsANegativeZero) {
  EXPECT_EQ(fixed(-0.0004, 2), "0.00");
  EXPECT_EQ(fixed(-0.0004, 2, true), "0.00");
  EXPECT_EQ(fixed(-1.25, 1, true), "−1.2");
  EXPECT_EQ(fixed(3.0, 1, true), "+3.0");
}

TEST(HtmlDataUri, IsBase64) {
  const test::TemporaryFolder folder;
  // RFC 4648, section 10.
  EXPECT_EQ(data_uri(folder.write("a", "foobar"), "text/plain"), "data:text/plain;base64,Zm9vYmFy");
  EXPECT_EQ(data_uri(folder.write("b", "fooba"), "text/plain"), "data:text/plain;base64,Zm9vYmE=");
  EXPECT_EQ(data_uri(folder.write("c", "foob"), "text/plain"), "data:text/plain;base64,Zm9vYg==");
}

}  // namespace
}  // namespace astroid::html
