#include "preproc/markup.h"

#include <gtest/gtest.h>

#include <string>

namespace belvedere {
namespace {

using namespace markup;

int CountOf(const std::string& text, const std::string& part) {
  int count = 0;
  for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

TEST(Markup, TextStaysText) {
  EXPECT_EQ(Escape("<a href=\"x\">'&amp;</a>"), "&lt;a href=&quot;x&quot;&gt;&#39;&amp;amp;&lt;/a&gt;");
  EXPECT_EQ(Escape("Zürich"), "Zürich");
}

TEST(Markup, NumbersAreWrittenForPeople) {
  EXPECT_EQ(Count(0), "0");
  EXPECT_EQ(Count(999), "999");
  EXPECT_EQ(Count(1'234'567), "1,234,567");
  EXPECT_EQ(Count(-123'456), "-123,456");
  EXPECT_EQ(Bytes(999), "999 B");
  EXPECT_EQ(Bytes(12'345), "12.3 kB");
  EXPECT_EQ(Bytes(612'200'000), "612.2 MB");
  EXPECT_EQ(Seconds(4.52), "4.5 s");
  EXPECT_EQ(Seconds(123), "2 min 03 s");
  EXPECT_EQ(Seconds(3725), "1 h 02 min");
  EXPECT_EQ(Distance(45.0 / 128), "39 km");
  EXPECT_EQ(Distance(45.0 / 128 / 2048), "19 m");
  EXPECT_EQ(Distance(45.0 / 128 / (1 << 22)), "0.0093 m");
  EXPECT_EQ(Extent({170, -20.5, 190, 10}), "170 E to 170 W, 20.5 S to 10 N");
  EXPECT_EQ(Extent({-180, -90, 180, 90}), "180 W to 180 E, 90 S to 90 N");
  EXPECT_EQ(Css({68, 1, 84}), "#440154");
}

TEST(Markup, AMapShowsEachSourceWhereItLies) {
  std::vector<SourceRecord> sources(3);
  sources[0].path = "world<1>.tif";
  sources[0].extent = {-180, -90, 180, 90};
  sources[1].extent = {170, -10, 190, 10};  // over 180 E: on both edges of the map
  sources[2].extent = {10, 40, 10.1, 40.1};
  const std::string map = Map("data:image/png;base64,AAAA", sources);
  EXPECT_NE(map.find("<title>world&lt;1&gt;.tif</title>"), std::string::npos);
  EXPECT_EQ(CountOf(map, "<rect x=\"0.0000\" y=\"0.0000\" width=\"360.0000\" height=\"180.0000\"/>"), 1);
  EXPECT_EQ(CountOf(map, "<rect x=\"350.0000\" y=\"80.0000\" width=\"20.0000\""), 1);
  EXPECT_EQ(CountOf(map, "<rect x=\"-10.0000\" y=\"80.0000\" width=\"20.0000\""), 1);
  EXPECT_EQ(CountOf(map, "<circle cx=\"190.0500\" cy=\"49.9500\""), 1) << "what is too small to be seen is ringed";
  EXPECT_EQ(CountOf(map, ">3</text>"), 1);
}

TEST(Markup, BarsAreAsHighAsTheirShare) {
  HeightHistogram histogram;
  histogram.first_m = -100;
  histogram.step_m = 50;
  histogram.posts = {10, 30, 0, 60};
  const std::string bars = Bars(histogram);
  EXPECT_NE(bars.find("height=\"140.00\"><title>50 to 100 m: 60.00 %"), std::string::npos) << bars;
  EXPECT_NE(bars.find("height=\"70.00\"><title>-50 to 0 m: 30.00 %"), std::string::npos) << bars;
  EXPECT_NE(bars.find(">-100 m</text>"), std::string::npos);
  EXPECT_NE(bars.find(">100 m</text>"), std::string::npos);
}

}  // namespace
}  // namespace belvedere
