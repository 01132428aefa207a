#include "runtime/base/iso_time.h"

#include <gtest/gtest.h>

namespace belvedere {
namespace {

TEST(IsoTimeTest, ReadsTimes) {
  EXPECT_EQ(ParseIsoTime("1970-01-01"), 0.0);
  EXPECT_EQ(ParseIsoTime("1970-01-02T00:00:01.5Z"), 86401.5);
  EXPECT_EQ(ParseIsoTime("2026-06-21T19:30:00Z"), 1782070200.0);
  EXPECT_EQ(ParseIsoTime("2026-06-21 12:30-07:00"), 1782070200.0);
  for (const char* bad :
       {"", "today", "2026-13-01", "2026-02-29", "2026-06-21T25:00", "2026-06-21T19:30:00Zx", "2026-6-1"}) {
    EXPECT_FALSE(ParseIsoTime(bad).has_value()) << bad;
  }
}

TEST(IsoTimeTest, WritesWhatItReads) {
  for (const char* text : {"1970-01-01T00:00:00Z", "2026-06-21T19:30:05Z", "1969-12-31T23:59:59Z",
                           "2024-02-29T12:00:00Z", "0001-01-01T00:00:00Z", "1903-07-04T00:00:00Z"}) {
    EXPECT_EQ(FormatIsoTime(*ParseIsoTime(text)), text);
  }
  EXPECT_EQ(FormatIsoTime(*ParseIsoTime("2026-06-21 12:30-07:00")), "2026-06-21T19:30:00Z");
}

}  // namespace
}  // namespace belvedere
