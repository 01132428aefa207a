#include "preproc/progress.h"

#include <gtest/gtest.h>

namespace belvedere {
namespace {

TEST(Progress, TheLineSaysRatesAndTheTimeLeft) {
  EXPECT_EQ(Progress::Line(250, 1000, 10, {.pages = 300, .bytes = 5'000'000}),
            "25 %, 300 pages, 30 pages/s, 0.5 MB/s, 0:30 left");
  EXPECT_EQ(Progress::Line(10, 1000, 60, {.pages = 10, .bytes = 0}),
            "1 %, 10 pages, 0 pages/s, 0.0 MB/s, 1:39:00 left");
  EXPECT_EQ(Progress::Line(1000, 1000, 10, {.pages = 1000, .bytes = 0}),
            "100 %, 1000 pages, 100 pages/s, 0.0 MB/s, 0:00 left");
}

TEST(Progress, NoTimeIsPromisedBeforeAnythingIsDone) {
  EXPECT_EQ(Progress::Line(0, 1000, 3, {}), "0 %, 0 pages, 0 pages/s, 0.0 MB/s, time left not known yet");
}

TEST(Progress, ItIsNotAllDoneBeforeAllIsDone) {
  EXPECT_EQ(Progress::Line(9999, 10000, 100, {.pages = 9999, .bytes = 0}).substr(0, 4), "99 %");
  EXPECT_EQ(Progress::Line(2000, 1000, 10, {}).substr(0, 5), "100 %") << "more than was planned";
}

}  // namespace
}  // namespace belvedere
