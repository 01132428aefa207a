#include "preproc/export_grid.h"

#include "runtime/paging/page.h"
#include "tests/preproc/made_raster.h"

#include <gtest/gtest.h>

#include <optional>

namespace belvedere {
namespace {

using namespace testing_rasters;

// Heights everywhere, fine ones over 180 E alone: 179 E to 179 W, 2 S to 2 N. Level 4.
class ExportGridTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    const std::string folder = FreshFolder("export_grid");
    const auto seven = [](int, int, int) { return 7.0; };
    Write(folder + "/seam.tif", {.width = 80, .height = 160, .affine = Degrees(179, 2, 0.025), .value = seven});
    Write(folder + "/colour.tif",
          {.width = 40, .height = 20, .type = GDT_Byte, .affine = Degrees(-180, 90, 9), .value = seven});
    MustBuild(folder, Layer("elevation", {"path = \"seam.tif\""}) + Layer("imagery", {"path = \"colour.tif\""}));
    dataset_ = MustOpen(folder).release();
  }
  static void TearDownTestSuite() { delete dataset_; }

  static ExportGrid Planned(int layer, std::optional<GeoBox> extent, std::optional<int> level) {
    const auto grid = PlanExport(*dataset_, layer, extent, level);
    EXPECT_TRUE(grid.ok()) << grid.message();
    return grid.ok() ? *grid : ExportGrid{};
  }
  static std::string Refusal(int layer, std::optional<GeoBox> extent, std::optional<int> level) {
    const auto grid = PlanExport(*dataset_, layer, extent, level);
    EXPECT_FALSE(grid.ok());
    return grid.message();
  }

  static const Dataset* dataset_;
};
const Dataset* ExportGridTest::dataset_ = nullptr;

TEST_F(ExportGridTest, WithoutAnExtentItIsWhereTheFinestLevelHasPages) {
  const ExportGrid grid = Planned(0, std::nullopt, std::nullopt);
  EXPECT_EQ(grid.level, 4);
  // A page of level 4 is 2.8125 degrees wide. Its siblings exist with it, so there are two each side of 180 E and of
  // the equator.
  const GeoBox box = grid.Box();
  EXPECT_EQ(box.west_deg, 180 - 2 * 2.8125);
  EXPECT_EQ(box.east_deg, 180 + 2 * 2.8125);
  EXPECT_EQ(box.south_deg, -2 * 2.8125);
  EXPECT_EQ(box.north_deg, 2 * 2.8125);
  EXPECT_EQ(grid.width, 4 * kCells + 1);
  EXPECT_EQ(grid.height, 4 * kCells + 1);
}

TEST_F(ExportGridTest, OnceRoundTheEarthHoldsNoPostTwiceAndBothPoles) {
  const ExportGrid posts = Planned(0, std::nullopt, 0);
  EXPECT_EQ(posts.width, 8 * kCells);
  EXPECT_EQ(posts.height, 4 * kCells + 1);
  EXPECT_EQ(posts.first_column, 0);
  EXPECT_EQ(posts.Box().north_deg, 90);
  const ExportGrid texels = Planned(1, std::nullopt, std::nullopt);
  EXPECT_EQ(texels.width, 8 * kImageInner);
  EXPECT_EQ(texels.height, 4 * kImageInner);
  const ExportGrid turned = Planned(0, GeoBox{10, -90, 370, 90}, 0);
  EXPECT_EQ(turned.width, 8 * kCells);
}

TEST_F(ExportGridTest, APixelsCentreIsAPostAndAPixelIsATexel) {
  const ExportGrid posts = Planned(0, GeoBox{0, 0, 45, 45}, 0);
  const auto of_posts = posts.GeoTransform();
  EXPECT_EQ(posts.width, kPosts);
  EXPECT_EQ(of_posts[0] + of_posts[1] / 2, 0);
  EXPECT_EQ(of_posts[3] + of_posts[5] / 2, 45);
  EXPECT_EQ(of_posts[0] + (128 + 0.5) * of_posts[1], 45);
  const auto of_texels = Planned(1, GeoBox{0, 0, 45, 45}, 0).GeoTransform();
  EXPECT_NEAR(of_texels[0], 0, 1e-12);
  EXPECT_NEAR(of_texels[3], 45, 1e-12);
}

TEST_F(ExportGridTest, AnExtentIsWidenedToWholeCells) {
  const double cell_deg = 45.0 / kCells;
  const ExportGrid grid = Planned(0, GeoBox{0.1, 0.1, 0.2, 0.2}, 0);
  EXPECT_EQ(grid.width, 2);
  EXPECT_EQ(grid.height, 2);
  EXPECT_EQ(grid.Box().east_deg, cell_deg);
  EXPECT_EQ(Planned(1, GeoBox{0.1, 0.1, 0.2, 0.2}, 0).width, 2);
}

TEST_F(ExportGridTest, AnExtentOver180EMayBeGivenEitherWay) {
  for (const GeoBox& box : {GeoBox{179, -1, -179, 1}, GeoBox{179, -1, 181, 1}, GeoBox{-181, -1, -179, 1}}) {
    const ExportGrid grid = Planned(0, box, std::nullopt);
    EXPECT_EQ(grid.level, 4);
    EXPECT_NEAR(grid.Box().west_deg, 179, 0.05);
    EXPECT_NEAR(grid.Box().east_deg, 181, 0.05);
  }
}

TEST_F(ExportGridTest, TheFinestLevelIsThatOfTheExtent) {
  EXPECT_EQ(Planned(0, GeoBox{10, 10, 20, 20}, std::nullopt).level, 0);
  EXPECT_EQ(Planned(0, GeoBox{160, 25, 165, 30}, std::nullopt).level, 1) << "siblings exist together";
  const std::string refusal = Refusal(0, GeoBox{10, 10, 20, 20}, 4);
  EXPECT_NE(refusal.find("no page of level 4 in that extent"), std::string::npos) << refusal;
  EXPECT_NE(Refusal(0, std::nullopt, 5).find("give a level from 0 to 4"), std::string::npos);
}

TEST_F(ExportGridTest, AnExtentThatIsNoneIsRefused) {
  EXPECT_NE(Refusal(0, GeoBox{0, 0, 1, 91}, std::nullopt).find("not on the Earth"), std::string::npos);
  EXPECT_NE(Refusal(0, GeoBox{0, 0, 400, 1}, std::nullopt).find("not on the Earth"), std::string::npos);
  EXPECT_NE(Refusal(0, GeoBox{0, 1, 1, 0}, std::nullopt).find("empty"), std::string::npos);
  EXPECT_NE(Refusal(0, GeoBox{5, 0, 5, 1}, std::nullopt).find("empty"), std::string::npos);
}

}  // namespace
}  // namespace belvedere
