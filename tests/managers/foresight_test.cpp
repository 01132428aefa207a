#include "managers/foresight.h"

#include "tests/managers/random_earth.h"

#include <gtest/gtest.h>

#include <set>

namespace belvedere {
namespace {

constexpr DataType kTerrain = 0;
constexpr DataType kImagery = 1;
constexpr ViewId kView = 7;
constexpr int kDeepest = 5;

LayerTable Layers() {
  LayerTable layers;
  const auto exists = [](Quadcode node) { return node.level() <= kDeepest; };
  layers.Add({"terrain", PageKind::kTerrain, 0, kDeepest, exists});
  layers.Add({"imagery", PageKind::kColour, 0, kDeepest, exists});
  return layers;
}

class ForesightTest : public testing::Test {
 protected:
  ForesightTest() {
    view_.view = kView;
    view_.number = 1;
    view_.error_px = 2;
    view_.image_layers = {{kImagery, LayerRole::kColour}};
    LookFrom(20, 30);
  }

  void LookFrom(double latitude_deg, double longitude_deg) {
    view_.eye_ecef = ToEcef({latitude_deg, longitude_deg, kHeight_m});
    view_.ecef_from_camera = CameraAxes(latitude_deg, longitude_deg, {}, Radians::FromDegrees(-90), {});
  }

  // One list of the view, as a manager makes it. Returns what it wished for.
  std::vector<PageKey> Wishes() {
    DisplayList list;
    ListPages pages(paging_, kTerrain, list);
    const Cut cut = SelectCut(view_, MatricesOf(view_, 0, kHeight_m), paging_.layers, kTerrain, {}, pages);
    const size_t waiting = pages.pages_waiting();
    if (!cut.waiting) Foresee(view_, 0, kHeight_m, paging_.layers, kTerrain, {}, pages);
    EXPECT_EQ(pages.pages_waiting(), waiting) << "what is foreseen is not waited for";
    pages.Finish(kView, ListPages::Queues::kTerrain);
    std::vector<PageKey> wishes;
    for (const DataType type : {kTerrain, kImagery}) {
      while (const std::optional<PageKey> key = paging_.queue(type).TryTake()) {
        wishes.push_back(*key);
        paging_.queue(type).Done(*key);
      }
    }
    return wishes;
  }

  void Serve(const std::vector<PageKey>& wishes) {
    for (const PageKey& key : wishes) {
      if (key.type == kImagery) {
        auto image = std::make_unique<ImagePage>();
        pins_.push_back(paging_.cache.Insert(key, std::move(image)));
        if (to_gpu_) pins_.back().page().residency()->Place(static_cast<int>(pins_.size()));
        continue;
      }
      auto page = test::FlatPage(key.node, std::vector<float>(kVerticesPerPage, 1.0F));
      page->error_m = key.node.level() < kDeepest ? 40'000.0F / static_cast<float>(1 << key.node.level()) : 0.0F;
      pins_.push_back(paging_.cache.Insert(key, std::move(page)));
    }
  }

  // Serves until a list of an eye that stands still wishes for nothing.
  void Settle() {
    const glm::dvec3 velocity = view_.eye_velocity_mps;
    view_.eye_velocity_mps = {};
    for (std::vector<PageKey> wishes = Wishes(); !wishes.empty(); wishes = Wishes()) Serve(wishes);
    view_.eye_velocity_mps = velocity;
  }

  static constexpr double kHeight_m = 1e6;
  ManualClock clock_;
  Paging paging_{Layers(), size_t{1} << 32, clock_};
  ViewParameters view_;
  std::vector<PagePin> pins_;
  bool to_gpu_ = true;
};

TEST_F(ForesightTest, AStandingEyeForeseesNothing) {
  Settle();
  EXPECT_TRUE(Wishes().empty());
}

TEST_F(ForesightTest, AMovingEyeAsksForWhatItWillSee) {
  Settle();
  const glm::dvec3 there = ToEcef({20, 45, kHeight_m});
  view_.eye_velocity_mps = (there - view_.eye_ecef) / kAhead_s;
  std::vector<PageKey> soon = Wishes();
  ASSERT_FALSE(soon.empty());
  std::set<PageKey> foreseen;
  to_gpu_ = false;  // images come to memory only
  for (; !soon.empty(); soon = Wishes()) {
    foreseen.insert(soon.begin(), soon.end());
    Serve(soon);
  }
  EXPECT_TRUE(std::any_of(foreseen.begin(), foreseen.end(), [](const PageKey& key) { return key.type == kImagery; }));
  // Come there, nothing is read any more.
  view_.eye_ecef = there;
  view_.eye_velocity_mps = {};
  const std::vector<PageKey> left = Wishes();
  EXPECT_LT(10 * left.size(), foreseen.size());
}

TEST_F(ForesightTest, WhatIsDrawnComesFirst) {
  const glm::dvec3 velocity_mps = (ToEcef({20, 45, kHeight_m}) - view_.eye_ecef) / kAhead_s;
  while (true) {
    view_.eye_velocity_mps = {};
    const std::vector<PageKey> own = Wishes();
    view_.eye_velocity_mps = velocity_mps;
    const std::vector<PageKey> all = Wishes();
    if (own.empty()) {
      EXPECT_FALSE(all.empty());
      break;
    }
    EXPECT_EQ(std::set<PageKey>(own.begin(), own.end()), std::set<PageKey>(all.begin(), all.end()))
        << "it waits for pages of its own";
    Serve(own);
  }
}

TEST_F(ForesightTest, APathIntoTheGroundIsForeseenHalfWay) {
  view_.eye_velocity_mps = -glm::normalize(view_.eye_ecef) * 1e6;  // there within a second
  EXPECT_NEAR(SecondsForeseen(view_, 0, kHeight_m), 0.5, 1e-9);
  view_.eye_velocity_mps *= -1;
  EXPECT_EQ(SecondsForeseen(view_, 0, kHeight_m), kAhead_s);
  view_.eye_velocity_mps = {};
  EXPECT_EQ(SecondsForeseen(view_, 0, kHeight_m), 0);
}

}  // namespace
}  // namespace belvedere
