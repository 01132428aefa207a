// What image layers do to the ground: roles, opacity, gamma, multiplier, on and off, as the view has them at the
// moment.
#include "render/ground_tint.h"
#include "render/renderer.h"

#include "tests/render/on_stage.h"

#include <gtest/gtest.h>

namespace belvedere::testing {
namespace {

constexpr double kMidnight_s = 12 * 3600;
constexpr Rgba kGround{100, 150, 200, 255};

class Layers : public OnStage {
 protected:
  void SetUp() override {
    Open(12);
    nodes_ = Block(0, 0, 10, 3);
    for (const Quadcode node : nodes_) scene_.AddTerrain(node, [](double, double) { return 0.0; });
    view_ = LookAt({0, 0, 5000}, 0, -90, 32, 32);
    view_.image_layers = {{scene_.colour_type(), LayerRole::kColour}, {scene_.overlay_type(), LayerRole::kMultiply}};
  }
  void Load(Rgba colour, std::optional<uint8_t> overlay) {
    std::vector<PagePin> pins;
    for (const Quadcode node : nodes_) {
      pins.push_back(scene_.AddColour(node, colour));
      if (overlay) pins.push_back(scene_.AddOverlay(node, *overlay));
    }
    for (PagePin& pin : pins) {
      std::vector<PagePin> one;
      one.push_back(std::move(pin));
      stage_->Upload(std::move(one));
    }
    DisplayList& list = stage_->channel->terrain_lists.back();
    list.Clear();
    AddSurface(list, scene_, nodes_, 32);
    list.statistics.height_above_ground_m = 5000;
    stage_->channel->terrain_lists.Publish();
  }
  // The same list again, with what `change` makes of a draw and the slot of another image.
  template <typename Change>
  void LoadAgain(Quadcode elsewhere, Rgba colour, Change change) {
    std::vector<PagePin> pins;
    pins.push_back(scene_.AddColour(elsewhere, colour));
    stage_->Upload(std::move(pins));
    DisplayList& list = stage_->channel->terrain_lists.back();
    list.Clear();
    AddSurface(list, scene_, nodes_, 32);
    const int other = PinInto(list, scene_.Find(scene_.colour_type(), elsewhere));
    for (TerrainDraw& draw : list.terrain_draws) change(draw, other);
    list.time_s = clock_.NowSeconds();
    list.statistics.height_above_ground_m = 5000;
    list.statistics.rises_until_s = list.time_s + 0.3;
    stage_->channel->terrain_lists.Publish();
  }
  // Blended in over another image from now on.
  void BlendOver(Rgba colour) {
    LoadAgain(Quadcode::Containing(50, 50, 10), colour, [](TerrainDraw& draw, int other) {
      draw.from[0] = draw.images[0];
      draw.from[0].slot = other;
      draw.fade_s[0] = 0.3F;
    });
  }
  // The colour in the middle of the picture, as the view is now: no new list is made for a change of it.
  Rgba Middle() {
    ++view_.number;
    stage_->channel->parameters.Publish(view_);
    stage_->Frame();
    const Picture picture = stage_->Take();
    const size_t middle = 3 * (16 * 32 + 16);
    return {picture.rgb[middle], picture.rgb[middle + 1], picture.rgb[middle + 2], 255};
  }
  static void ExpectNear(const Rgba& a, const Rgba& b, int tolerance) {
    for (size_t i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], tolerance) << "channel " << i;
  }

  std::vector<Quadcode> nodes_;
  ViewParameters view_;
};

TEST_F(Layers, OpacityLetsThroughWhatIsUnder) {
  Load(kGround, std::nullopt);
  const Rgba whole = Middle();
  view_.image_layers[0].opacity = 0;
  const Rgba bare = Middle();
  view_.image_layers[0].opacity = 0.5F;
  const Rgba half = Middle();
  for (size_t i = 0; i < 3; ++i) EXPECT_NEAR(half[i], (whole[i] + bare[i]) / 2, 3);
  EXPECT_GT(bare[0], whole[0] + 30);
}

TEST_F(Layers, OffIsAsIfItWereNotThere) {
  Load(kGround, 200);
  view_.image_layers[1].opacity = 0;
  const Rgba colour_alone = Middle();
  view_.image_layers[1] = {scene_.overlay_type(), LayerRole::kMultiply};
  view_.image_layers[1].on = false;
  ExpectNear(Middle(), colour_alone, 0);
  view_.image_layers[1].on = true;
  EXPECT_GT(Middle()[0], colour_alone[0] + 30);
}

TEST_F(Layers, GammaAndMultiplierChangeTheTexel) {
  Load(kGround, std::nullopt);
  const Rgba plain = Middle();
  view_.image_layers[0].multiplier = 0.5F;
  const Rgba darker = Middle();
  EXPECT_LT(darker[0], plain[0] * 0.7);
  view_.image_layers[0].multiplier = 1;
  view_.image_layers[0].gamma = 2;
  const Rgba contrasted = Middle();
  // 100 of 255 squared is 39, 200 is 157.
  EXPECT_NEAR(static_cast<double>(contrasted[0]) / plain[0], 0.39, 0.08);
  EXPECT_NEAR(static_cast<double>(contrasted[2]) / plain[2], 0.78, 0.08);
}

TEST_F(Layers, GreyHasNoHue) {
  Load(kGround, std::nullopt);
  view_.image_layers[0].role = LayerRole::kGrey;
  const Rgba grey = Middle();
  EXPECT_NEAR(grey[0], grey[1], 8);  // but for the air
  EXPECT_NEAR(grey[1], grey[2], 8);
}

TEST_F(Layers, AnImageIsBlendedInOverTheOneBefore) {
  Load(kGround, std::nullopt);
  const Rgba after = Middle();
  BlendOver({20, 20, 20, 255});
  const Rgba before = Middle();
  clock_.Advance(0.15);
  const Rgba half = Middle();
  clock_.Advance(0.15);
  ExpectNear(Middle(), after, 0);
  for (size_t i = 0; i < 3; ++i) EXPECT_NEAR(half[i], (before[i] + after[i]) / 2, 4);
  EXPECT_LT(before[2], after[2] - 60);
}

// A bright overlay that goes, or comes, leaves no shadow meanwhile.
TEST_F(Layers, WhereOneOfTheTwoIsTransparentTheOtherKeepsItsColour) {
  Load({0, 0, 0, 0}, std::nullopt);
  const Rgba after = Middle();  // bare ground
  BlendOver({250, 250, 250, 255});
  const Rgba before = Middle();
  clock_.Advance(0.15);
  const Rgba half = Middle();
  for (size_t i = 0; i < 3; ++i) EXPECT_NEAR(half[i], (before[i] + after[i]) / 2, 4);
  EXPECT_GT(before[1], after[1] + 20);
}

TEST_F(Layers, AGreyOverlayLetsThroughWhereItIsTransparent) {
  Load(kGround, std::nullopt);
  const auto over = [&](uint8_t alpha) {
    const Quadcode elsewhere = Quadcode::Containing(50, 50 + alpha / 10.0, 10);
    LoadAgain(elsewhere, {230, 230, 230, alpha}, [](TerrainDraw& draw, int other) {
      draw.images[1] = draw.images[0];
      draw.images[1].slot = other;
    });
    return Middle();
  };
  view_.image_layers = {{scene_.colour_type(), LayerRole::kColour}, {scene_.colour_type(), LayerRole::kGrey}};
  const Rgba bare = over(0), half = over(128), whole = over(255);
  view_.image_layers.pop_back();
  ExpectNear(Middle(), bare, 0);
  EXPECT_GT(whole[0], bare[0] + 60);
  for (size_t i = 0; i < 3; ++i) EXPECT_NEAR(half[i], (whole[i] + bare[i]) / 2, 3);
}

TEST_F(Layers, ATintShowsHowTheGroundIsDrawn) {
  Load(kGround, std::nullopt);
  const Rgba plain = Middle();
  view_.tint = GroundTint::kError;  // none is left: blue
  const Rgba none_left = Middle();
  EXPECT_GT(none_left[2], none_left[0] + 60);
  view_.tint = GroundTint::kNone;
  ExpectNear(Middle(), plain, 0);
}

TEST_F(Layers, VolumesAreDrawnOverTheGround) {
  Load(kGround, std::nullopt);
  const auto lines = [&] {
    ++view_.number;
    stage_->channel->parameters.Publish(view_);
    stage_->Frame();
    const Picture picture = stage_->Take();
    int count = 0;
    for (size_t i = 0; i < picture.rgb.size(); i += 3) count += picture.rgb[i] > 200 && picture.rgb[i + 2] < 60 ? 1 : 0;
    return count;
  };
  EXPECT_EQ(lines(), 0);
  view_ = LookAt({0, 0, 60'000}, 0, -90, 96, 96);
  view_.volumes = true;
  EXPECT_GT(lines(), 40);
}

TEST(GroundTintTest, ErrorsGoFromBlueOverYellowToRed) {
  const auto channel = [](uint32_t colour, int which) { return colour >> (8 * which) & 0xFFU; };
  EXPECT_EQ(channel(ErrorColour(0, 1), 2), 255U);
  EXPECT_EQ(channel(ErrorColour(0, 1), 0), 0U);
  EXPECT_EQ(channel(ErrorColour(1, 1), 0), 255U);
  EXPECT_EQ(channel(ErrorColour(1, 1), 1), 255U);
  EXPECT_EQ(channel(ErrorColour(9, 1), 0), 255U);
  EXPECT_EQ(channel(ErrorColour(9, 1), 1), 0U);
}

TEST_F(Layers, NightLightsShineInTheDarkAlone) {
  Load({10, 10, 10, 255}, 255);
  view_.image_layers[1].role = LayerRole::kNight;
  view_.image_layers[0].on = true;
  const Rgba day = Middle();
  view_.image_layers[1].on = false;
  ExpectNear(Middle(), day, 0);
  view_.utc_s += kMidnight_s;
  const Rgba dark = Middle();
  view_.image_layers[1].on = true;
  const Rgba lit = Middle();
  EXPECT_LT(dark[0], 40);
  EXPECT_GT(lit[0], 200);
}

TEST_F(Layers, TheSunGlintsOnWaterWhereItIsMirrored) {
  Load({10, 20, 60, 255}, 255);
  view_.image_layers[1].role = LayerRole::kWater;
  // From where the ground under the middle of the picture mirrors the sun, and from the other side.
  view_.utc_s = 1'710'936'000;  // 2024-03-20 12:00 UTC: the sun over the equator
  const auto eye_at = [&](double longitude_deg) {
    const Geodetic eye{0, longitude_deg, 4000};
    const ViewParameters look = LookAt(eye, longitude_deg < 0 ? 90 : 270, -40, 32, 32);
    view_.eye_ecef = look.eye_ecef;
    view_.ecef_from_camera = look.ecef_from_camera;
    return Middle();
  };
  view_.utc_s += 3 * 3600;  // it stands 45 degrees over the west
  const Rgba towards = eye_at(0.043);
  const Rgba away = eye_at(-0.043);
  EXPECT_GT(towards[0], away[0] + 25);
  view_.image_layers[1].on = false;
  EXPECT_LT(eye_at(0.043)[0], towards[0] - 25);
}

}  // namespace
}  // namespace belvedere::testing
