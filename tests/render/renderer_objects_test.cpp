// Moving objects, drawn off-screen.
#include "render/renderer.h"

#include "tests/render/on_stage.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace belvedere::testing {
namespace {

constexpr int kWidth = 200, kHeight = 160;

// A cube of 2 m, green, in two details of which the coarser is a single triangle.
std::unique_ptr<ModelPage> Cube() {
  auto page = std::make_unique<ModelPage>();
  for (int axis = 0; axis < 3; ++axis) {
    for (const float side : {-1.0F, 1.0F}) {
      const auto first = static_cast<uint32_t>(page->vertices.size());
      for (const auto& [a, b] : {std::pair{-1.0F, -1.0F}, {1.0F, -1.0F}, {1.0F, 1.0F}, {-1.0F, 1.0F}}) {
        std::array<float, 3> p{};
        std::array<float, 3> n{};
        p[static_cast<size_t>(axis)] = n[static_cast<size_t>(axis)] = side;
        p[static_cast<size_t>((axis + 1) % 3)] = a * side;
        p[static_cast<size_t>((axis + 2) % 3)] = b;
        page->vertices.push_back({p[0], p[1], p[2], n[0], n[1], n[2], {20, 220, 20}, 0});
      }
      for (const uint32_t corner : {0U, 1U, 2U, 0U, 2U, 3U}) page->indices.push_back(first + corner);
    }
  }
  page->details = {{0, 36, 0}, {0, 3, 1}};
  page->radius_m = 1.8F;
  return page;
}

class Objects : public OnStage {
 protected:
  void SetUp() override {
    Open(24);
    std::vector<PagePin> pins;
    pins.push_back(scene_.AddModel(0, Cube()));
    stage_->Upload(std::move(pins));
    view_ = LookAt({36.0, -118.0, 3000}, 0, -90, kWidth, kHeight);
    view_.utc_s += 8 * 3600;  // noon at 118 W
  }
  // An object level and heading north, its model scaled so that it is `size_m` across.
  ObjectInstance At(const Geodetic& where, float size_m) {
    ObjectInstance instance;
    instance.position_ecef = ToEcef(where);
    const LevelAxes axes = LevelAxesAt(where.latitude_deg, where.longitude_deg);
    instance.ecef_from_body = {axes.north, axes.east, -axes.up};
    instance.radius_m = size_m;
    instance.look.scale = size_m / 2;
    instance.look.model_slot = 0;
    return instance;
  }
  void Publish(const std::vector<ObjectInstance>& instances, const std::vector<std::string>& labels = {""}) {
    DisplayList& list = stage_->channel->object_lists.back();
    list.Clear();
    list.instances = instances;
    for (const std::string& label : labels) list.labels.push_back({label, LabelSide::kRight});
    list.number = 1;
    PinInto(list, scene_.AddModel(0, Cube()));
    list.records.push_back({ListRecord::Kind::kDrawInstances, 0, static_cast<uint32_t>(instances.size()), 0});
    stage_->channel->object_lists.Publish();
  }
  Picture Draw() {
    stage_->channel->parameters.Publish(view_);
    stage_->Frame();
    return stage_->Take();
  }
  struct Blob {
    size_t pixels = 0;
    glm::dvec2 centre{0.0};
  };
  template <typename Test>
  static Blob Find(const Picture& picture, Test test) {
    Blob blob;
    for (int y = 0; y < picture.height_px; ++y) {
      for (int x = 0; x < picture.width_px; ++x) {
        if (!test(&picture.rgb[3 * static_cast<size_t>(y * picture.width_px + x)])) continue;
        ++blob.pixels;
        blob.centre += glm::dvec2(x + 0.5, y + 0.5);
      }
    }
    if (blob.pixels > 0) blob.centre /= static_cast<double>(blob.pixels);
    return blob;
  }
  static Blob Green(const Picture& picture) {
    return Find(picture, [](const uint8_t* rgb) { return rgb[1] > 60 && rgb[0] < rgb[1] / 2 && rgb[2] < rgb[1] / 2; });
  }
  static glm::dvec2 Projected(const Picture& picture, const glm::dvec3& ecef) {
    const glm::dvec4 clip = picture.matrices.clip_from_ecef * glm::dvec4(ecef, 1.0);
    return {(0.5 + 0.5 * clip.x / clip.w) * picture.width_px, (0.5 - 0.5 * clip.y / clip.w) * picture.height_px};
  }

  ViewParameters view_;
};

TEST_F(Objects, AModelIsWhereClipFromEcefPutsIt) {
  const ObjectInstance one = At({36.004, -118.003, 1000}, 150);
  const ObjectInstance two = At({35.997, -117.998, 500}, 100);
  Publish({one, two});
  view_.ecef_from_camera = CameraAxes(36.0, -118.0, Radians{}, Radians::FromDegrees(-89), Radians{});
  Picture picture = Draw();
  const glm::dvec2 expected = Projected(picture, one.position_ecef);
  for (int y = 0; y < kHeight; ++y) {  // leave only the first one's half
    for (int x = kWidth / 2; x < kWidth; ++x) picture.rgb[3 * static_cast<size_t>(y * kWidth + x) + 1] = 0;
  }
  const Blob blob = Green(picture);
  EXPECT_GT(blob.pixels, 30U);
  EXPECT_NEAR(blob.centre.x, expected.x, 1.5);
  EXPECT_NEAR(blob.centre.y, expected.y, 1.5);
  EXPECT_EQ(picture.triangles, 24U);
  EXPECT_EQ(picture.object_list, 1U);
}

TEST_F(Objects, DepthOfAModelIsItsDistance) {
  Publish({At({36.0, -118.0, 1000}, 400)});
  const Picture picture = Draw();
  EXPECT_NEAR(picture.depth_m[static_cast<size_t>(kHeight / 2 * kWidth + kWidth / 2)], 1800, 1);
}

TEST_F(Objects, MovesBetweenTwoLists) {
  ObjectInstance mover = At({36.0, -118.0, 1000}, 100);
  mover.velocity_mps = 400.0 * LevelAxesAt(36.0, -118.0).east;
  Publish({mover});
  const Blob before = Green(Draw());
  view_.time_s = 1.0;
  const Picture picture = Draw();
  const Blob after = Green(picture);
  EXPECT_GT(after.centre.x, before.centre.x + 10);
  EXPECT_NEAR(after.centre.x, Projected(picture, mover.position_ecef + mover.velocity_mps).x, 1.5);
}

TEST_F(Objects, TheDetailThatTheListAsksForIsDrawn) {
  ObjectInstance far = At({36.0, -118.0, 1000}, 100);
  far.look.detail = 1;
  Publish({far});
  EXPECT_EQ(Draw().triangles, 1U);
  far.look.detail = 9;  // coarser than there is: the coarsest
  Publish({far});
  EXPECT_EQ(Draw().triangles, 1U);
}

TEST_F(Objects, SymbolsKeepTheirSizeAndForceColour) {
  ObjectInstance object = At({36.0, -118.0, 0}, 10);
  object.look.model_slot = -1;
  object.look.symbol = static_cast<uint8_t>(SymbolShape::kGround);
  object.look.colour = {40, 90, 255, 255};
  const auto blue = [](const uint8_t* rgb) { return rgb[2] > 200 && rgb[0] < 80; };
  size_t pixels[2] = {};
  for (int i = 0; i < 2; ++i) {
    view_.eye_ecef = ToEcef({36.0, -118.0, i == 0 ? 3000.0 : 300e3});
    Publish({object});
    const Blob blob = Find(Draw(), blue);
    pixels[i] = blob.pixels;
    EXPECT_NEAR(blob.centre.x, kWidth / 2, 1.0);
    EXPECT_NEAR(blob.centre.y, kHeight / 2, 1.0);
  }
  EXPECT_GT(pixels[0], 100U);
  EXPECT_NEAR(static_cast<double>(pixels[0]), static_cast<double>(pixels[1]), 6);
}

TEST_F(Objects, ALabelStandsBesideItsObject) {
  ObjectInstance object = At({36.0, -118.0, 0}, 10);
  object.look.model_slot = -1;
  object.look.symbol = static_cast<uint8_t>(SymbolShape::kAir);
  object.look.colour = {255, 230, 20, 255};
  object.label = 1;
  const auto yellow = [](const uint8_t* rgb) { return rgb[0] > 200 && rgb[1] > 180 && rgb[2] < 110; };
  Publish({object}, {"", "N42"});
  const Blob with_label = Find(Draw(), yellow);
  view_.labels = false;
  const Blob without = Find(Draw(), yellow);
  EXPECT_GT(without.pixels, 50U);
  EXPECT_GT(with_label.pixels, without.pixels + 30);
  EXPECT_GT(with_label.centre.x, without.centre.x + 2);
}

TEST_F(Objects, CanBeHidden) {
  Publish({At({36.0, -118.0, 1000}, 100)});
  view_.draw_objects = false;
  EXPECT_EQ(Green(Draw()).pixels, 0U);
  view_.draw_objects = true;
  EXPECT_GT(Green(Draw()).pixels, 0U);
}

}  // namespace
TEST_F(Objects, JointsMoveTheirPartOfTheModel) {
  auto gun = Cube();  // 2 m, its pivot 4 m behind it
  for (ModelVertex& vertex : gun->vertices) vertex.joint = static_cast<uint8_t>(ModelJoint::kTurret);
  gun->pivots[static_cast<size_t>(ModelJoint::kTurret)] = {-4, 0, 0};
  gun->radius_m = 8;
  std::vector<PagePin> pins;
  pins.push_back(scene_.AddModel(1, std::move(gun)));
  stage_->Upload(std::move(pins));
  const auto draw = [&](float turret_rad) {
    ObjectInstance object = At({36.0, -118.0, 1000}, 100);
    object.look.model_slot = 1;
    object.joints.turret_rad = turret_rad;
    Publish({object});
    return Green(Draw());
  };
  const Blob ahead = draw(0), right = draw(1.5708F);
  EXPECT_NEAR(ahead.centre.x, kWidth / 2, 2);  // heading north, seen from above
  EXPECT_GT(right.centre.x, ahead.centre.x + 8);
  EXPECT_GT(right.centre.y, ahead.centre.y + 8);
}

TEST_F(Objects, EffectsAreBlendedWhereTheyAre) {
  view_.sky = false;
  view_.background = {0.2F, 0.2F, 0.2F};
  const auto draw = [&](EffectInstance::Shape shape, EffectInstance::Shape other, double height_m) {
    DisplayList& list = stage_->channel->object_lists.back();
    list.Clear();
    list.number = 1;
    for (const auto& [east_deg, one] : {std::pair{-0.004, shape}, {0.004, other}}) {
      EffectInstance& effect = list.effects.emplace_back();
      effect.from_ecef = effect.to_ecef = ToEcef({36.0, -118.0 + east_deg, height_m});
      if (one == EffectInstance::Shape::kDisc) effect.to_ecef += LevelAxesAt(36.0, -118.0).up;
      effect.from_m = effect.to_m = 150;
      effect.from_colour = effect.to_colour = {0, 0, 255, 255};
      effect.shape = one;
    }
    stage_->channel->object_lists.Publish();
    return Draw();
  };
  const auto blue_at = [&](const Picture& picture, int x) {
    const uint8_t* rgb = &picture.rgb[3 * static_cast<size_t>(kHeight / 2 * kWidth + x)];
    return std::pair<int, int>{rgb[2], rgb[0]};
  };
  Publish({});
  const Picture plain = Draw();
  const glm::dvec2 left = Projected(plain, ToEcef({36.0, -118.004, 500}));
  const glm::dvec2 right = Projected(plain, ToEcef({36.0, -117.996, 500}));
  const int left_x = static_cast<int>(left.x), right_x = static_cast<int>(right.x);
  const Picture picture = draw(EffectInstance::Shape::kGlow, EffectInstance::Shape::kLine, 500);
  EXPECT_GT(blue_at(picture, left_x).first, blue_at(plain, left_x).first + 20);
  EXPECT_GE(blue_at(picture, left_x).second, blue_at(plain, left_x).second);  // light is added,
  EXPECT_GT(blue_at(picture, right_x).first, 150);
  EXPECT_LT(blue_at(picture, right_x).second, 40);  // a line covers
  EXPECT_NEAR(blue_at(picture, kWidth / 2).first, blue_at(plain, kWidth / 2).first, 2);
  const Picture disc = draw(EffectInstance::Shape::kDisc, EffectInstance::Shape::kPuff, 500);
  EXPECT_LT(blue_at(disc, left_x).second, blue_at(plain, left_x).second / 2 + 20);
  EXPECT_LT(blue_at(disc, right_x).second, blue_at(plain, right_x).second / 2 + 60);
}

}  // namespace belvedere::testing
