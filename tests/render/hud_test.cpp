#include "render/hud.h"

#include <gtest/gtest.h>

namespace belvedere {
namespace {

TEST(Hud, SaysWhatItWasGiven) {
  HudFacts facts;
  facts.frame_ms = 20;
  facts.error_asked_px = 2;
  facts.error_achieved_px = 1.68;
  facts.pages_waiting = 3;
  facts.uploads_pending = 4;
  facts.triangles = 25013;
  facts.has_terrain = true;
  facts.latitude_deg = -37.5;
  facts.longitude_deg = -118.25;
  facts.height_m = 12'300;
  facts.notices = {"elevation 3:01: checksum differs"};
  const std::vector<std::string> lines = HudTextOf(facts).lines;
  ASSERT_EQ(lines.size(), 5U);
  EXPECT_NE(lines[0].find("50 frames/s"), std::string::npos) << lines[0];
  EXPECT_NE(lines[1].find("error 2.0 px asked, 1.7 achieved"), std::string::npos) << lines[1];
  EXPECT_NE(lines[1].find("7 pages waiting"), std::string::npos) << lines[1];
  EXPECT_NE(lines[2].find("25013 triangles"), std::string::npos) << lines[2];
  EXPECT_NE(lines[3].find("37.5000\xB0 S  118.2500\xB0 W"), std::string::npos) << lines[3];
  EXPECT_NE(lines[3].find("12.3 km"), std::string::npos) << lines[3];
  EXPECT_EQ(lines[4], facts.notices[0]);
}

TEST(Hud, SaysWhatIsHeldInPlaceOfWhatWasAsked) {
  HudFacts facts;
  facts.has_terrain = true;
  facts.error_asked_px = 1;
  facts.error_held_px = 1.6;
  facts.error_achieved_px = 1.5;
  EXPECT_NE(HudTextOf(facts).lines[1].find("error 1.0 px asked, holding 1.6"), std::string::npos)
      << HudTextOf(facts).lines[1];
}

// Before the notices; what there is none of is not said.
TEST(Hud, SaysWhereThePagesOfALayerAre) {
  HudFacts facts;
  facts.layer_pages = {{"terrain", 0, 412, 3, 0}, {"imagery", 30, 2, 0, 1}};
  facts.notices = {"one"};
  const HudText text = HudTextOf(facts);
  ASSERT_EQ(text.lines.size(), 7U);
  EXPECT_EQ(text.lines[4], "terrain:   412 in memory   3 asked for");
  EXPECT_EQ(text.lines[5], "imagery:   30 on the GPU   2 in memory   1 failed");
  EXPECT_EQ(text.first_notice, 6U);
}

TEST(Hud, BoundsItsNotices) {
  HudFacts facts;
  facts.notices.assign(100, std::string(10'000, 'x'));
  const std::vector<std::string> lines = HudTextOf(facts).lines;
  EXPECT_LE(lines.size(), 8U);
  EXPECT_LT(lines.back().size(), 200U);
}

TEST(Hud, Lengths) {
  EXPECT_EQ(LengthText(0.123), "0.12 m");
  EXPECT_EQ(LengthText(850), "850 m");
  EXPECT_EQ(LengthText(12'345), "12.3 km");
  EXPECT_EQ(LengthText(12'345'678), "12 346 km");
  EXPECT_EQ(LengthText(-400), "-400 m");
}

TEST(Hud, StandsInTheUpperLeftCornerOverEverything) {
  const Atlas atlas("/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf");
  OverlayBatch batch(atlas);
  AddHud({{"one line"}, 1}, batch);
  EXPECT_EQ(batch.vertices().size() % 4, 0U);
  EXPECT_GE(batch.vertices().size(), 4U * (1 + 7));
  for (const auto& vertex : batch.vertices()) {
    EXPECT_GE(vertex.x, 0);
    EXPECT_LT(vertex.x, 200);
    EXPECT_LT(vertex.y, 40);
    EXPECT_EQ(vertex.depth, kFrontDepth);
  }
}

}  // namespace
}  // namespace belvedere
