#include "render/object_overlay.h"

#include "render/view_block.h"
#include "runtime/earth/ellipsoid.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace belvedere {
namespace {

class ObjectOverlay : public ::testing::Test {
 protected:
  ObjectOverlay() {
    view_.eye_ecef = ToEcef({0, 0, 10e3});
    view_.ecef_from_camera = CameraAxes(0, 0, Radians{}, Radians::FromDegrees(-90), Radians{});
    view_.symbols = true;
    list_.labels.emplace_back();
  }
  // An aircraft at a place over the equator that heads that way.
  void Put(double longitude_deg, double heading_deg, const std::string& label, LabelSide side = LabelSide::kRight) {
    ObjectInstance instance;
    instance.position_ecef = ToEcef({0, longitude_deg, 1000});
    const glm::dmat3 camera = CameraAxes(0, longitude_deg, Radians::FromDegrees(heading_deg), Radians{}, Radians{});
    instance.ecef_from_body = {-camera[2], camera[0], -camera[1]};  // forward, right, down
    instance.radius_m = 20;
    instance.look.symbol = static_cast<uint8_t>(SymbolShape::kAir);
    instance.look.colour = {255, 80, 80, 255};
    if (!label.empty()) {
      instance.label = static_cast<uint32_t>(list_.labels.size());
      list_.labels.push_back({label, side});
    }
    list_.instances.push_back(instance);
  }
  const std::vector<OverlayBatch::Vertex>& Build() {
    const ViewMatrices matrices = MatricesOf(view_, 0, 9000);
    const InstanceRange all{0, static_cast<uint32_t>(list_.instances.size())};
    const auto moved = MoveObjects(list_, {&all, 1}, view_, matrices, 0);
    AddObjectOverlay(list_, moved, view_, matrices, batch_);
    return batch_.vertices();
  }

  static constexpr float kMiddle_px = 512;
  ViewParameters view_;
  DisplayList list_;
  const Atlas atlas_{"/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf"};
  OverlayBatch batch_{atlas_};
};

TEST_F(ObjectOverlay, ASymbolTurnsWithTheHeading) {
  Put(0, 90, "");
  const auto& vertices = Build();
  ASSERT_EQ(vertices.size(), 4U);
  // The upper edge of the symbol, first two corners, looks east.
  EXPECT_GT(vertices[0].x, kMiddle_px + 5);
  EXPECT_GT(vertices[1].x, kMiddle_px + 5);
  EXPECT_LT(vertices[2].x, kMiddle_px - 5);
  EXPECT_EQ(vertices[0].colour, (OverlayBatch::Colour{255, 80, 80, 255}));
  EXPECT_GT(vertices[0].depth, 0);
}

TEST_F(ObjectOverlay, LabelsStandBesideTheirObjects) {
  Put(0, 0, "AB");
  const auto& vertices = Build();
  ASSERT_EQ(vertices.size(), 4U * 3);
  for (size_t i = 4; i < vertices.size(); ++i) EXPECT_GT(vertices[i].x, kMiddle_px + 8);
}

TEST_F(ObjectOverlay, ABlockThatStandsOffIsJoinedToItsObject) {
  Put(0, 0, "AB\nC", LabelSide::kUpperLeft);
  const auto& vertices = Build();
  ASSERT_EQ(vertices.size(), 4U * 5);  // symbol, line, three letters
  float lowest = 0, highest = 1e9F;
  for (size_t i = 8; i < vertices.size(); ++i) {
    EXPECT_LT(vertices[i].x, kMiddle_px - 13);
    lowest = std::max(lowest, vertices[i].y);
    highest = std::min(highest, vertices[i].y);
  }
  EXPECT_LT(lowest, 384 - 20);
  EXPECT_GT(lowest - highest, kLabelLine_px);
}

TEST_F(ObjectOverlay, LabelsCanBeOffAndModelsHaveNoSymbol) {
  Put(0, 0, "ABCDE");
  view_.labels = false;
  view_.symbols = false;
  list_.instances[0].look.model_slot = 3;
  EXPECT_TRUE(Build().empty());
}

TEST_F(ObjectOverlay, FromFarOutTheGlobeCutsNoLabel) {
  view_.eye_ecef = ToEcef({0, 0, 12'000e3});
  for (const double longitude_deg : {-55.0, -30.0, 30.0, 55.0}) {
    Put(longitude_deg, 0, "ABCDEFGH", longitude_deg < 0 ? LabelSide::kRight : LabelSide::kUpperLeft);
  }
  const ViewMatrices matrices = MatricesOf(view_, 0, 9000);
  for (const OverlayBatch::Vertex& vertex : Build()) {
    // Where the line of sight through the corner meets the globe.
    const double right = (static_cast<double>(vertex.x) - 0.5 * view_.width_px) / matrices.pixels_per_radian;
    const double up = (0.5 * view_.height_px - static_cast<double>(vertex.y)) / matrices.pixels_per_radian;
    const glm::dvec3 ray = view_.ecef_from_camera * glm::dvec3(right, up, -1);
    const double along = -glm::dot(ray, view_.eye_ecef) / glm::dot(ray, ray);
    const glm::dvec3 nearest = view_.eye_ecef + along * ray;
    const double inside = kEquatorialRadius_m * kEquatorialRadius_m - glm::dot(nearest, nearest);
    if (inside < 0) continue;  // beside it
    const double axis_m = along - std::sqrt(inside / glm::dot(ray, ray));
    EXPECT_GT(vertex.depth, DepthAt(matrices.clip_from_camera, view_.projection, axis_m))
        << vertex.x << " " << vertex.y;
  }
}

TEST_F(ObjectOverlay, CloseToTheEyeLabelsStandClearOfTheGroundBeforeTheirObject) {
  // distance of the label over that of the object
  const auto nearness = [&](double eye_m) {
    list_.instances.clear();
    batch_.Clear();
    view_.eye_ecef = ToEcef({0, 0, 1000 + eye_m});
    Put(0, 0, "A");
    const ViewMatrices matrices = MatricesOf(view_, 0, 9000);
    const float at_object = DepthAt(matrices.clip_from_camera, view_.projection, eye_m);
    return static_cast<double>(at_object / Build().back().depth);
  };
  EXPECT_NEAR(nearness(100), 0.5, 0.01);
  EXPECT_NEAR(nearness(8000), 0.97, 0.03) << "an object behind a hill has no label before it";
}

}  // namespace
}  // namespace belvedere
