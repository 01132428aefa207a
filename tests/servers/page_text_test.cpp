#include "servers/page_text.h"

#include "servers/quadcode_frame.h"
#include "tests/servers/image_test_pages.h"

#include <gtest/gtest.h>

#include <thread>

namespace belvedere {
namespace {

constexpr TexelColour kInk = {255, 255, 255};
constexpr TexelColour kHalo = {0, 0, 0};

TEST(PageText, CoversByStraightAlpha) {
  const auto page = MakeTransparentPage({10, 20, 30});
  EXPECT_EQ(RgbaAt(*page, 7, 9), (Rgba{10, 20, 30, 0}));
  CoverTexel(*page, 7, 9, {200, 100, 50}, 0.5F);
  EXPECT_EQ(RgbaAt(*page, 7, 9), (Rgba{200, 100, 50, 128}));
  CoverTexel(*page, 7, 9, {0, 0, 0}, 1);
  EXPECT_EQ(RgbaAt(*page, 7, 9), (Rgba{0, 0, 0, 255}));
}

TEST(PageText, IsUprightWithinItsBox) {
  const PageText text;
  ASSERT_TRUE(text.font().ok()) << text.font().message();
  const TexelBox box = text.BoxAround("L", 100, 50);
  EXPECT_TRUE(box.west < 100 && box.east > 100 && box.south < 50 && box.north > 50);
  const auto page = MakeTransparentPage(kInk);
  text.Write(*page, box, "L", kInk, kHalo);
  int low = 0, high = 0;
  for (int row = 0; row < kImageSide; ++row) {
    for (int column = 0; column < kImageSide; ++column) {
      const Rgba texel = RgbaAt(*page, column, row);
      const bool inside = column >= box.west && column < box.east && row >= box.south && row < box.north;
      ASSERT_TRUE(inside || texel[3] == 0);
      (row < 50 ? low : high) += texel[3] > 0 ? texel[0] : 0;
    }
  }
  EXPECT_GT(low, high + 400);  // the foot of the L
}

TEST(PageText, WithoutTheFontNothingIsWritten) {
  EXPECT_NE(NoText().font().message().find("/no/such/font.ttf"), std::string::npos);
  const auto page = MakeTransparentPage(kInk);
  NoText().Write(*page, NoText().BoxAround("12", 100, 50), "12", kInk, kHalo);
  EXPECT_EQ(page->texels, MakeTransparentPage(kInk)->texels);
}

TEST(PageText, ManyThreadsWriteTheSame) {
  const PageText text;
  std::array<std::unique_ptr<ImagePage>, 4> pages;
  std::vector<std::thread> threads;
  threads.reserve(pages.size());
  for (auto& page : pages) {
    threads.emplace_back([&] { page = DrawQuadcodeFrame(Quadcode::Containing(47, 8, 12), text); });
  }
  for (std::thread& thread : threads) thread.join();
  for (const auto& page : pages) EXPECT_EQ(page->texels, pages[0]->texels);
}

TEST(QuadcodeFrame, LiesOnTheBorderAndNamesTheQuadnode) {
  const PageText text;
  const Quadcode node = Quadcode::Containing(47, 8, kMaxLevel);  // the longest name
  const auto page = DrawQuadcodeFrame(node, text);
  const auto nameless = DrawQuadcodeFrame(node, NoText());
  for (const int along : {3, 4, 251, 252}) {
    EXPECT_GT(AlphaAt(*page, along, 90), 150);
    EXPECT_GT(AlphaAt(*page, 90, along), 150);
  }
  EXPECT_EQ(AlphaAt(*page, 2, 90), 0);
  EXPECT_EQ(AlphaAt(*page, 5, 90), 0);
  EXPECT_EQ(AlphaAt(*nameless, 128, 128), 0);
  int written = 0;
  for (int column = 0; column < kImageSide; ++column) written += AlphaAt(*page, column, 128) > 0 ? 1 : 0;
  EXPECT_GT(written, 100);
  ExpectNoSeam(*nameless, *DrawQuadcodeFrame(Quadcode::Root(3), NoText()), true, 0);
}

}  // namespace
}  // namespace belvedere
