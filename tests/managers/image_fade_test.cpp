#include "managers/image_fade.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <vector>

namespace belvedere {
namespace {

constexpr DataType kImagery = 1;

// Images that are on the GPU, each in a slot of its own.
class FakePages final : public PageAccess {
 public:
  const TerrainPage* Terrain(Quadcode) override { return nullptr; }
  std::optional<int> Slot(const PageKey& key) override {
    if (const auto step = steps.find(key); step != steps.end()) return step->second;
    const auto found = slots.find(key.node);
    return found == slots.end() ? std::nullopt : std::optional<int>(found->second);
  }
  bool Want(const PageKey&, float) override { return true; }
  std::map<Quadcode, int> slots;
  std::map<PageKey, int> steps;  // and those of which it matters of which step they are
};

class ImageFadeTest : public testing::Test {
 protected:
  ImageFadeTest() { pages_.slots = {{kRoot, 7}, {kChild, 8}, {kGrandchild, 9}}; }
  // A node of a list that shows the image of `source`, made as the cut makes it.
  CutNode Shown(Quadcode node, Quadcode source, double now_s, bool jump = false) {
    CutNode shown;
    shown.node = node;
    const int levels = node.level() - source.level();
    const auto scale = static_cast<float>(std::ldexp(1.0, -levels));
    const auto across = (int64_t{1} << levels) - 1;
    shown.images[0] = {pages_.slots.at(source),
                       scale * static_cast<float>(node.column() & across),
                       scale * static_cast<float>(node.row() & across),
                       scale,
                       scale,
                       source,
                       kImagery};
    fade_.Apply(std::span(&shown, 1), layers_, now_s, jump, pages_);
    return shown;
  }

  const Quadcode kRoot = Quadcode::Root(5);
  const Quadcode kChild = kRoot.Child(3);
  const Quadcode kGrandchild = kChild.Child(1);
  const std::vector<LayerUse> layers_{{kImagery}};
  FakePages pages_;
  ImageFade fade_;
};

TEST_F(ImageFadeTest, AFinerImageIsBlendedInOverThePartOfTheCoarserThatWasThere) {
  Shown(kRoot, kRoot, 0);
  const CutNode node = Shown(kChild, kChild, 1);
  EXPECT_EQ(node.images[0].slot, 8);
  EXPECT_EQ(node.from[0].slot, 7);
  EXPECT_EQ(node.from[0].scale_u, 0.5F);
  EXPECT_EQ(node.from[0].offset_u, 0.5F);  // child 3 is the one in the north-east
  EXPECT_EQ(node.from[0].offset_v, 0.5F);
  EXPECT_DOUBLE_EQ(node.fade_until_s[0], 1 + ImageFade::kFade_s);
  EXPECT_DOUBLE_EQ(fade_.until_s(), 1 + ImageFade::kFade_s);
}

TEST_F(ImageFadeTest, GoesOnFromListToListAndEnds) {
  Shown(kChild, kRoot, 0);
  Shown(kChild, kChild, 1);
  const CutNode later = Shown(kChild, kChild, 1.2);
  EXPECT_EQ(later.from[0].slot, 7);
  EXPECT_DOUBLE_EQ(later.fade_until_s[0], 1 + ImageFade::kFade_s);
  const CutNode after = Shown(kChild, kChild, 1.4);
  EXPECT_EQ(after.from[0].slot, -1);
  EXPECT_EQ(after.fade_until_s[0], 0);
  EXPECT_EQ(fade_.until_s(), 0);
}

TEST_F(ImageFadeTest, TheNextImageWaitsUntilTheLastIsThere) {
  Shown(kGrandchild, kRoot, 0);
  Shown(kGrandchild, kChild, 1);
  const CutNode waiting = Shown(kGrandchild, kGrandchild, 1.1);
  EXPECT_EQ(waiting.images[0].slot, 8);
  EXPECT_EQ(waiting.from[0].slot, 7);
  EXPECT_TRUE(fade_.waits()) << "another list is needed";
  const CutNode next = Shown(kGrandchild, kGrandchild, 1.4);
  EXPECT_EQ(next.images[0].slot, 9);
  EXPECT_EQ(next.from[0].slot, 8);
  EXPECT_FALSE(fade_.waits());
}

TEST_F(ImageFadeTest, ShowsAtOnceWhatItCannotBlend) {
  Shown(kChild, kRoot, 0);
  EXPECT_EQ(Shown(kChild, kChild, 1, true).from[0].slot, -1) << "the eye has jumped";
  Shown(kChild, kRoot, 2, true);
  pages_.slots.erase(kRoot);
  EXPECT_EQ(Shown(kChild, kChild, 3).from[0].slot, -1) << "the image before is gone";
}

TEST_F(ImageFadeTest, AnotherStepOfTheLayerIsBlendedInOverTheOneBefore) {
  constexpr DataType kNextStep = 4;
  const auto shown = [&](DataType type, int slot, double now_s) {
    pages_.steps[{type, kChild}] = slot;
    CutNode node;
    node.node = kChild;
    node.images[0] = {slot, 0, 0, 1, 1, kChild, type};
    fade_.Apply(std::span(&node, 1), layers_, now_s, false, pages_);
    return node;
  };
  shown(kImagery, 8, 0);
  const CutNode node = shown(kNextStep, 20, 1);
  EXPECT_EQ(node.images[0].slot, 20);
  EXPECT_EQ(node.from[0].slot, 8) << "of the same quadnode, but of the step before";
  EXPECT_EQ(node.from[0].type, kImagery);
  EXPECT_DOUBLE_EQ(node.fade_until_s[0], 1 + ImageFade::kFade_s);
  const CutNode still = shown(kNextStep, 20, 1.2);
  EXPECT_EQ(still.from[0].slot, 8);
  EXPECT_EQ(shown(kNextStep, 20, 1.4).from[0].slot, -1);
}

}  // namespace
}  // namespace belvedere
