// Draws off-screen and looks at the pixels.
#include "render/renderer.h"

#include "runtime/base/clock.h"
#include "tests/render/on_stage.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace belvedere::testing {
namespace {

constexpr int kWidth = 160, kHeight = 120;

bool IsMagenta(const Picture& picture, size_t pixel) {
  return picture.rgb[3 * pixel] == 255 && picture.rgb[3 * pixel + 1] == 0 && picture.rgb[3 * pixel + 2] == 255;
}
size_t MagentaPixels(const Picture& picture) {
  size_t count = 0;
  for (size_t pixel = 0; pixel < picture.depth_m.size(); ++pixel) count += IsMagenta(picture, pixel) ? 1 : 0;
  return count;
}
size_t Middle(const Picture& picture) {
  return static_cast<size_t>(picture.height_px / 2) * static_cast<size_t>(picture.width_px) +
         static_cast<size_t>(picture.width_px / 2);
}
double Rugged(double latitude_deg, double longitude_deg) {
  return 400 + 300 * std::sin(latitude_deg * 2000) * std::cos(longitude_deg * 1700);
}

class Drawing : public OnStage {
 protected:
  void SetUp() override { Open(24); }

  void Load(const std::vector<Quadcode>& nodes, const Height& height) {
    for (const Quadcode node : nodes) scene_.AddTerrain(node, height);
    nodes_ = nodes;
  }
  void Load(PagePin pin) {
    std::vector<PagePin> pins;
    pins.push_back(std::move(pin));
    stage_->Upload(std::move(pins));
  }
  void Fill(const ViewParameters& view, int step) {
    stage_->channel->parameters.Publish(view);
    DisplayList& list = stage_->channel->terrain_lists.back();
    list.Clear();
    AddSurface(list, scene_, nodes_, step);
    list.statistics.height_above_ground_m = 500;
  }
  Picture Draw(const ViewParameters& view, int step = 8) {
    Fill(view, step);
    stage_->Show(++number_);
    return stage_->Take();
  }

  std::vector<Quadcode> nodes_;
  uint64_t number_ = 0;
};

TEST_F(Drawing, WithNoListTheBackgroundShows) {
  stage_->channel->parameters.Publish(LookAt({10, 10, 5000}, 0, -90, kWidth, kHeight));
  stage_->Frame();
  const Picture picture = stage_->Take();
  EXPECT_EQ(MagentaPixels(picture), static_cast<size_t>(kWidth * kHeight));
  EXPECT_TRUE(std::isinf(picture.depth_m[0]));
  EXPECT_EQ(picture.terrain_list, 0U);
}

TEST_F(Drawing, DepthIsInMetresAlongTheViewAxis) {
  Load(Block(10, 10, 10, 3), [](double, double) { return 250.0; });
  const Picture down = Draw(LookAt({10.0, 10.0, 3250}, 0, -90, kWidth, kHeight));
  EXPECT_NEAR(down.depth_m[Middle(down)], 3000, 0.5);
  // Along the axis, not along the ray: the corner is as deep as the middle, but for the Earth's curve.
  EXPECT_NEAR(down.depth_m[0], 3000, 2);
  const Picture slanted = Draw(LookAt({10.0, 10.0, 1250}, 30, -45, kWidth, kHeight));
  EXPECT_NEAR(slanted.depth_m[Middle(slanted)], 1000 * std::sqrt(2.0), 15);
}

TEST_F(Drawing, AMarkIsWhereClipFromEcefPutsIt) {
  const Geodetic peak{10.01, 10.02, 900};
  Load(Block(10, 10, 10, 3), [&](double latitude, double longitude) {
    const double away = std::hypot(latitude - peak.latitude_deg, longitude - peak.longitude_deg);
    return 900 * std::max(0.0, 1.0 - away / 0.01);
  });
  const Picture picture = Draw(LookAt({10.0, 10.01, 6000}, 20, -80, kWidth, kHeight), 1);
  // The nearest point of the picture along the axis is the tip of the cone.
  const auto nearest = std::min_element(picture.depth_m.begin(), picture.depth_m.end()) - picture.depth_m.begin();
  const glm::dvec4 clip = picture.matrices.clip_from_ecef * glm::dvec4(ToEcef(peak), 1.0);
  EXPECT_NEAR(static_cast<double>(nearest % kWidth) + 0.5, (0.5 + 0.5 * clip.x / clip.w) * kWidth, 1.5);
  EXPECT_NEAR(static_cast<double>(nearest / kWidth) + 0.5, (0.5 - 0.5 * clip.y / clip.w) * kHeight, 1.5);
}

// Quadnodes of nine coordinate frames meet at shared vertices: no background shows between them, wherever the eye is.
TEST_F(Drawing, NothingShowsBetweenQuadnodesOfDifferentFrames) {
  const Quadcode middle = Quadcode::Containing(40, -105, 9);
  const GeoBox box = middle.Ancestor(8).Box();
  std::vector<Quadcode> nodes = Block(box.south_deg, box.west_deg, 9, 4);  // around a corner of four frames
  std::set<Quadcode> frames;
  for (const Quadcode node : nodes) frames.insert(FrameNode(node));
  ASSERT_GE(frames.size(), 4U);
  Load(nodes, Rugged);
  for (int pose = 0; pose < 24; ++pose) {
    const Geodetic eye{box.south_deg + 0.01 * std::sin(pose), box.west_deg + 0.01 * std::cos(pose * 1.7),
                       1500.0 + 250 * pose};
    const Picture picture = Draw(LookAt(eye, 15.0 * pose, -90 + pose % 5 * 4, kWidth, kHeight), pose % 2 == 0 ? 4 : 16);
    EXPECT_EQ(MagentaPixels(picture), 0U) << "pose " << pose;
  }
}

// A vertex that is shared by quadnodes with other images, drawn by other programs, is at the same place to the last
// bit: quadnodes with no image, one, and two alternate and still nothing shows between them.
TEST_F(Drawing, NothingShowsBetweenQuadnodesWithOtherImages) {
  const std::vector<Quadcode> nodes = Block(-33.3, 18.4, 11, 4);
  Load(nodes, Rugged);
  for (size_t i = 0; i < nodes.size(); ++i) {
    if (i % 3 > 0) Load(scene_.AddColour(nodes[i], {200, 120, 60, 255}));
    if (i % 3 > 1) Load(scene_.AddOverlay(nodes[i], 128));
  }
  const GeoBox corner = nodes[10].Box();
  for (int pose = 0; pose < 12; ++pose) {
    const Geodetic eye{corner.south_deg + 0.002 * std::sin(pose), corner.west_deg + 0.003 * std::cos(pose * 1.7),
                       1200.0 + 200 * pose};
    const Picture picture = Draw(LookAt(eye, 31.0 * pose, -85, kWidth, kHeight));
    EXPECT_EQ(MagentaPixels(picture), 0U) << "pose " << pose;
  }
}

TEST_F(Drawing, BothCapturesOfOneListHaveTheSameBytes) {
  Load(Block(10, 10, 12, 3), Rugged);
  ViewParameters view = LookAt({9.98, 10.0, 2500}, 10, -30, kWidth, kHeight);
  view.sky = true;
  const Picture once = Draw(view);
  const Picture twice = stage_->Take();
  EXPECT_EQ(once.rgb, twice.rgb);
  EXPECT_EQ(once.depth_m, twice.depth_m);
  EXPECT_EQ(once.terrain_list, number_);
  EXPECT_EQ(once.triangles, twice.triangles);
  EXPECT_GT(once.triangles, 0U);
}

// While pages come, coarse ground may be drawn over the eye; under it there would be no picture.
TEST_F(Drawing, AnEyeUnderTheDrawnGroundLooksFromJustOverIt) {
  Load(Block(10, 10, 10, 3), [](double, double) { return 900.0; });
  for (const double pitch_deg : {-90.0, -40.0, -25.0}) {
    const Picture picture = Draw(LookAt({10, 10, 400}, 0, pitch_deg, kWidth, kHeight));
    const double eye_m = ToGeodetic(picture.matrices.eye_ecef).height_m;
    EXPECT_GT(eye_m, 900.0);
    EXPECT_LT(eye_m, 910.0);
    EXPECT_FALSE(IsMagenta(picture, Middle(picture)));
    EXPECT_FALSE(IsMagenta(picture, picture.depth_m.size() - 1));
  }
  const Picture over = Draw(LookAt({10, 10, 1400}, 0, -90, kWidth, kHeight));
  EXPECT_NEAR(ToGeodetic(over.matrices.eye_ecef).height_m, 1400.0, 1e-6);
}

TEST_F(Drawing, ImagesColourTheirQuadnode) {
  const std::vector<Quadcode> nodes = Block(10, 10, 12, 1);
  Load(nodes, [](double, double) { return 0.0; });
  // West half red, east half green; north third blue.
  Load(scene_.AddColourOf(nodes[0], [](double u, double v) {
    if (v > 2.0 / 3) return Rgba{0, 0, 250, 255};
    return u < 0.5 ? Rgba{250, 0, 0, 255} : Rgba{0, 250, 0, 255};
  }));
  const GeoBox box = nodes[0].Box();
  const auto colour_at = [&](double u, double v) {
    const Geodetic eye{box.south_deg + v * (box.north_deg - box.south_deg),
                       box.west_deg + u * (box.east_deg - box.west_deg), 300};
    const Picture picture = Draw(LookAt(eye, 0, -90, kWidth, kHeight));
    const size_t pixel = 3 * Middle(picture);
    return std::array<int, 3>{picture.rgb[pixel], picture.rgb[pixel + 1], picture.rgb[pixel + 2]};
  };
  EXPECT_GT(colour_at(0.25, 0.3)[0], 200);
  EXPECT_LT(colour_at(0.25, 0.3)[1], 30);
  EXPECT_GT(colour_at(0.75, 0.3)[1], 200);
  EXPECT_GT(colour_at(0.75, 0.9)[2], 200);
  EXPECT_LT(colour_at(0.25, 0.9)[0], 30);
}

TEST_F(Drawing, OverlaysScaleTheColour) {
  const std::vector<Quadcode> nodes = Block(20, 5, 12, 1);
  Load(nodes, [](double, double) { return 0.0; });
  const GeoBox box = nodes[0].Box();
  const ViewParameters view = LookAt({0.5 * (box.south_deg + box.north_deg), 0.5 * (box.west_deg + box.east_deg), 500},
                                     0, -90, kWidth, kHeight);
  const auto red = [&] {
    const Picture picture = Draw(view);
    return static_cast<int>(picture.rgb[3 * Middle(picture)]);
  };
  Load(scene_.AddColour(nodes[0], {120, 120, 120, 255}));
  const int plain = red();
  EXPECT_NEAR(plain, 120, 6);  // noon in June: full light, hardly any air
  Load(scene_.AddOverlay(nodes[0], 64));
  EXPECT_NEAR(red(), plain / 2, 3);
}

TEST_F(Drawing, NightIsDark) {
  Load(Block(10, 0, 12, 1), [](double, double) { return 0.0; });
  ViewParameters view = LookAt({10, 0.01, 500}, 0, -90, kWidth, kHeight);
  const Picture noon = Draw(view);
  view.utc_s += 12 * 3600;
  const Picture midnight = Draw(view);
  const int day = noon.rgb[3 * Middle(noon)];
  const int night = midnight.rgb[3 * Middle(midnight)];
  EXPECT_GT(day, 140);
  EXPECT_NEAR(night, 0.12 * day, 8);
}

TEST_F(Drawing, TheSkyFillsWhatNothingElseDoes) {
  ViewParameters view = LookAt({0, 0, 2000}, 0, 5, kWidth, kHeight);
  view.sky = true;
  stage_->channel->parameters.Publish(view);
  stage_->Frame();
  const Picture low = stage_->Take();
  EXPECT_EQ(MagentaPixels(low), 0U);
  const size_t top = 3 * static_cast<size_t>(kWidth / 2);
  EXPECT_GT(low.rgb[top + 2], 2 * low.rgb[top]);  // blue above
  const size_t bottom = 3 * (static_cast<size_t>(kHeight - 1) * kWidth + kWidth / 2);
  EXPECT_GT(low.rgb[bottom], low.rgb[top]);  // brighter at the horizon
  EXPECT_TRUE(std::isinf(low.depth_m[0]));

  view.eye_ecef = ToEcef({0, 0, 20e6});  // looks past the Earth
  stage_->channel->parameters.Publish(view);
  const Picture space = stage_->Take();
  EXPECT_LT(space.rgb[top] + space.rgb[top + 1] + space.rgb[top + 2], 12);
}

TEST_F(Drawing, ReportsWhatItDrew) {
  Load(Block(10, 10, 12, 3), Rugged);
  Draw(LookAt({10, 10, 3000}, 0, -90, kWidth, kHeight));
  const auto report = stage_->channel->frame.Get();
  EXPECT_EQ(report->terrain_list, number_);
  EXPECT_GT(report->nodes, 0U);
  EXPECT_LE(report->nodes, 9U);
  EXPECT_EQ(report->triangles, report->nodes * 2 * 16 * 16);
  const auto samples = stage_->recorder.Take();
  EXPECT_EQ(samples.back().triangles, report->triangles);
  EXPECT_TRUE(samples.back().has_terrain);
}

TEST_F(Drawing, CaptureOfAViewThatIsNotThereFails) {
  EXPECT_FALSE(stage_->renderer->Capture(77, Renderer::Moment::kOfParameters).ok());
  stage_->renderer->RemoveView(1);
  EXPECT_FALSE(stage_->renderer->Capture(1, Renderer::Moment::kOfParameters).ok());
}

TEST_F(Drawing, AMinimisedWindowIsSkipped) {
  stage_->channel->parameters.Publish(LookAt({10, 10, 3000}, 0, -90, 0, 0));
  stage_->Frame();
  EXPECT_EQ(stage_->channel->frame.Get()->frame, 0U);
  EXPECT_FALSE(stage_->renderer->Capture(1, Renderer::Moment::kOfParameters).ok());
}

TEST_F(Drawing, SamplesMixColoursAtEdgesAndDepthIsThereAsWithout) {
  // Ground that ends within the picture.
  const ViewParameters view = LookAt({10.0, 10.0, 30'250}, 20, -90, kWidth, kHeight);
  Load(Block(10, 10, 12, 2), [](double, double) { return 250.0; });
  const auto mixed = [&](int samples) {
    Open(24, samples);
    const Picture picture = Draw(view);
    EXPECT_NEAR(picture.depth_m[Middle(picture)], 30'000, 1);
    const int ground = picture.rgb[3 * Middle(picture) + 1];
    EXPECT_GT(ground, 60);
    size_t between = 0;
    for (size_t i = 1; i < picture.rgb.size(); i += 3)
      between += picture.rgb[i] > 0 && picture.rgb[i] < ground * 9 / 10 ? 1 : 0;
    return between;
  };
  EXPECT_EQ(mixed(0), 0U);
  EXPECT_GT(mixed(4), 20U);
}

TEST_F(Drawing, ALargeListComesInSharesWhileTheOneBeforeIsDrawn) {
  Load(Block(10, 10, 12, 4), Rugged);
  const ViewParameters view = LookAt({10, 10, 3000}, 0, -90, kWidth, kHeight);
  const Picture before = Draw(view, 32);
  Fill(view, 1);
  stage_->channel->terrain_lists.back().number = 2;
  stage_->channel->terrain_lists.Publish();
  stage_->Frame();
  const Picture during = stage_->Take();
  EXPECT_EQ(during.terrain_list, before.terrain_list);
  EXPECT_EQ(during.rgb, before.rgb);
  EXPECT_EQ(during.triangles, before.triangles);

  const DisplayList& list = stage_->channel->terrain_lists.coming();
  const size_t bytes = list.vertices->size() * sizeof(ListVertex) + list.indices.size() * sizeof(uint32_t);
  ASSERT_GT(bytes, 2 * kListBytesAFrame);
  size_t frames = 1;
  for (; stage_->Take().terrain_list == before.terrain_list && frames < 100; ++frames) stage_->Frame();
  EXPECT_EQ(frames, (bytes + kListBytesAFrame - 1) / kListBytesAFrame);
  const Picture after = stage_->Take();
  EXPECT_EQ(MagentaPixels(after), 0U);
  EXPECT_GT(after.triangles, 100 * before.triangles);
}

TEST_F(Drawing, AViewOfWhichNothingChangesKeepsItsPicture) {
  Load(Block(10, 10, 12, 3), Rugged);
  ViewParameters view = LookAt({10, 10, 3000}, 0, -90, kWidth, kHeight);
  Draw(view);
  const auto frames = [&] { return stage_->channel->frame.Get()->frame; };
  const uint64_t before = frames();
  stage_->Frame();
  stage_->Frame();
  EXPECT_EQ(frames(), before);
  stage_->recorder.Take();

  view.number = 2;
  stage_->channel->parameters.Publish(view);
  stage_->Frame();
  EXPECT_EQ(frames(), before + 1) << "other parameters";
  EXPECT_EQ(stage_->recorder.Take().back().frame_ms, 0.0) << "a frame after a pause is not a late one";
  stage_->channel->terrain_lists.Publish();
  stage_->Frame();
  EXPECT_EQ(frames(), before + 2) << "another list";
  stage_->renderer->SetNotices({"a page failed"});
  stage_->Frame();
  EXPECT_EQ(frames(), before + 3) << "another notice";
  stage_->renderer->SetNotices({"a page failed"});
  stage_->Frame();
  EXPECT_EQ(frames(), before + 3);
  clock_.Advance(1.5);
  stage_->Frame();
  EXPECT_EQ(frames(), before + 4) << "the sun goes on";
  view.eye_velocity_mps = {100, 0, 0};
  stage_->channel->parameters.Publish(view);
  for (int i = 0; i < 3; ++i) stage_->Frame();
  EXPECT_EQ(frames(), before + 7) << "an eye that flies";
  view.eye_velocity_mps = {0, 0, 0};
  view.time_rate = 3600;
  stage_->channel->parameters.Publish(view);
  for (int i = 0; i < 3; ++i) stage_->Frame();
  EXPECT_EQ(frames(), before + 10) << "a sun that goes fast";
}

TEST_F(Drawing, TheHudIsDrawnOverThePicture) {
  ViewParameters view = LookAt({10, 10, 3000}, 0, -90, 640, 480);
  view.hud = true;
  stage_->channel->parameters.Publish(view);
  stage_->Frame();
  const Picture picture = stage_->Take();
  size_t text = 0;
  for (size_t pixel = 0; pixel < picture.depth_m.size(); ++pixel) text += picture.rgb[3 * pixel + 1] > 180 ? 1 : 0;
  EXPECT_GT(text, 300U);
  EXPECT_LT(text, 20'000U);
  EXPECT_TRUE(IsMagenta(picture, picture.depth_m.size() - 1));
}

}  // namespace
}  // namespace belvedere::testing
