// A dataset that is changed has the pages of one that is built of the same sources, and no page is written that is the
// same as before.

#include "preproc/update.h"

#include "preproc/changed_extents.h"
#include "tests/preproc/changed_dataset.h"

#include <set>

namespace belvedere {
namespace {

using namespace testing_rasters;

struct Inset {
  const char* what;
  std::array<double, 6> affine;
  int width, height;
};
// Each where pages hold posts of others: within one, on borders of trees, over 180 E, at a pole.
const Inset kInsets[] = {{"within", Degrees(11.2, 47.9, 0.02), 30, 20},
                         {"tree_corner", Degrees(44.8, 0.25, 0.02), 20, 25},
                         {"over_180", Degrees(179.7, -10, 0.02), 30, 20},
                         {"pole", Degrees(-30, 90, 0.03), 33, 20},
                         {"border_of_quadnodes", Degrees(22.5, 22.5, 0.02), 15, 15}};

TEST(Update, AddedAndRemovedIsAsIfBuiltSo) {
  for (const Inset& inset : kInsets) {
    SCOPED_TRACE(inset.what);
    const std::string folder = FreshFolder(std::string("update_") + inset.what);
    Noise(folder + "/world.tif", 1, 256, 128, Degrees(-180, 90, 360.0 / 256), 1, 40);
    Noise(folder + "/colours.tif", 2, 256, 128, Degrees(-180, 90, 360.0 / 256), 3);
    Noise(folder + "/inset.tif", 3, inset.width, inset.height, inset.affine);
    Noise(folder + "/photo.tif", 4, inset.width, inset.height, inset.affine, 3);
    const std::string world = "path = \"world.tif\"", colours = "path = \"colours.tif\"";
    const std::string fine = "path = \"inset.tif\"\nfeather_m = 500\ndatum = \"ellipsoid\"",
                      photo = "path = \"photo.tif\"";
    MustBuild(folder, Layer("elevation", {world}) + Layer("imagery", {colours}));
    const Pages before = PagesOf(folder);

    const auto added = Add(folder, Layer("elevation", {fine}) + Layer("imagery", {photo}));
    ASSERT_TRUE(added.ok()) << added.message();
    const Pages after = PagesOf(folder);
    ExpectSame(after, BuiltWhole("update_whole", folder,
                                 Layer("elevation", {world, fine}) + Layer("imagery", {colours, photo})));
    EXPECT_EQ(added->written, CountNew(before, after)) << "only what differs is written";
    EXPECT_GT(added->written, 8);
    EXPECT_EQ(added->removed, 0);

    const auto removed = Remove(folder, "inset.tif");
    ASSERT_TRUE(removed.ok()) << removed.message();
    ExpectSame(PagesOf(folder),
               BuiltWhole("update_whole", folder, Layer("elevation", {world}) + Layer("imagery", {colours, photo})));
    ASSERT_TRUE(Remove(folder, folder + "/photo.tif", "imagery").ok());
    ExpectSame(PagesOf(folder), before);
  }
}

TEST(Update, OnlyWhatTheSourceCoversIsRead) {
  const std::string folder = FreshFolder("update_covered");
  Noise(folder + "/world.tif", 1, 2048, 1024, Degrees(-180, 90, 360.0 / 2048), 1, 40);
  Noise(folder + "/inset.tif", 3, 40, 40, Degrees(11.2, 47.9, 0.01));
  MustBuild(folder, Layer("elevation", {"path = \"world.tif\""}));
  const Pages before = PagesOf(folder);
  ASSERT_TRUE(Add(folder, Layer("elevation", {"path = \"inset.tif\""})).ok());
  const std::vector<GeoBox> extent = {MustOpen(folder)->layers()[0].sources.at(1).extent};
  int touched = 0, others = 0;
  for (const auto& [key, value] : PagesOf(folder)) {
    const Quadcode node = *Quadcode::FromWord(key.second);
    if (Touches(extent, LayerKind::kElevation, node) || !before.contains(key)) {
      ++touched;
      EXPECT_TRUE(node.is_root() || Touches(extent, LayerKind::kElevation, node.Parent())) << node.ToString();
    } else {
      ++others;
      EXPECT_TRUE(before.at(key) == value) << node.ToString();
    }
  }
  EXPECT_GT(touched, 8);
  EXPECT_GT(others, 100);
}

TEST(Update, ASourceInTheMiddleIsRemoved) {
  const std::string folder = FreshFolder("update_middle");
  Noise(folder + "/world.tif", 1, 128, 64, Degrees(-180, 90, 360.0 / 128), 1, 40);
  Noise(folder + "/middle.tif", 2, 60, 60, Degrees(10, 50, 0.02));
  Noise(folder + "/top.tif", 3, 40, 40, Degrees(10.5, 49.8, 0.01));
  MustBuild(folder, Layer("elevation", {"path = \"world.tif\"", "path = \"middle.tif\"", "path = \"top.tif\""}));
  ASSERT_TRUE(Remove(folder, "middle.tif").ok());
  ExpectSame(PagesOf(folder),
             BuiltWhole("update_whole", folder, Layer("elevation", {"path = \"world.tif\"", "path = \"top.tif\""})));
}

TEST(Update, ASourceThatHasChangedIsReadAnew) {
  const std::string folder = FreshFolder("update_changed");
  Noise(folder + "/world.tif", 1, 128, 64, Degrees(-180, 90, 360.0 / 128), 1, 40);
  Noise(folder + "/inset.tif", 2, 60, 60, Degrees(10, 50, 0.02));
  const std::string text = Layer("elevation", {"path = \"world.tif\"", "path = \"inset.tif\""});
  MustBuild(folder, text);
  const Pages before = PagesOf(folder);
  const auto nothing = Refresh(folder);
  ASSERT_TRUE(nothing.ok()) << nothing.message();
  EXPECT_EQ(nothing->written, 0);
  EXPECT_FALSE(fs::exists(folder + "/out/change-1.mdb"));
  // It moves: what it covered goes back to the world, what it covers comes.
  Noise(folder + "/inset.tif", 5, 50, 60, Degrees(100, -20, 0.02));
  const auto changed = Refresh(folder);
  ASSERT_TRUE(changed.ok()) << changed.message();
  EXPECT_GT(changed->removed, 0);
  const Pages after = PagesOf(folder);
  EXPECT_EQ(changed->written, CountNew(before, after));
  ExpectSame(after, BuiltWhole("update_whole", folder, text));
}

// What lies below a void is shifted to meet its rims, so that a change on the rim reaches all over it.
TEST(Update, VoidsOverWhatChangesAreFilledAnew) {
  const std::string folder = FreshFolder("update_voids");
  Noise(folder + "/world.tif", 1, 128, 64, Degrees(-180, 90, 360.0 / 128), 1, 40);
  Noise(folder + "/rim.tif", 2, 40, 60, Degrees(10, 50.3, 0.02));
  Write(folder + "/holed.tif",
        {.width = 90,
         .height = 90,
         .affine = Degrees(10.4, 50, 0.02),
         .value =
             [](int, int column, int row) {
               return column > 12 && column < 60 && row > 30 && row < 70 ? -9999.0 : 500.0 + 3 * column + row;
             },
         .finish = [](GDALDataset& d) { d.GetRasterBand(1)->SetNoDataValue(-9999); }});
  MustBuild(folder, Layer("elevation", {"path = \"world.tif\"", "path = \"rim.tif\"", "path = \"holed.tif\""}));
  ASSERT_TRUE(Remove(folder, "rim.tif").ok());
  ExpectSame(PagesOf(folder),
             BuiltWhole("update_whole", folder, Layer("elevation", {"path = \"world.tif\"", "path = \"holed.tif\""})));
}

TEST(Update, ColoursAreMatchedToWhatLiesBelowNow) {
  const std::string folder = FreshFolder("update_colours");
  Noise(folder + "/world.tif", 1, 512, 256, Degrees(-180, 90, 360.0 / 512), 3);
  Noise(folder + "/below.tif", 2, 100, 100, Degrees(10, 50, 0.04), 3);
  Write(folder + "/photo.tif",
        {.width = 200,
         .height = 200,
         .bands = 3,
         .type = GDT_Byte,
         .affine = Degrees(9, 51, 0.04),
         .value = [](int band, int column, int row) { return band * 20.0 + (column + row) / 4; }});
  const std::string photo = "path = \"photo.tif\"\nmatch_colour = true";
  MustBuild(folder, Layer("imagery", {"path = \"world.tif\"", "path = \"below.tif\"", photo}));
  const auto before = MustOpen(folder)->layers()[0].sources.at(2).colour_fit;
  ASSERT_TRUE(before);
  ASSERT_TRUE(Remove(folder, "below.tif").ok());
  const auto after = MustOpen(folder)->layers()[0].sources.at(1).colour_fit;
  ASSERT_TRUE(after);
  EXPECT_NE(after->offset, before->offset);
  ExpectSame(PagesOf(folder), BuiltWhole("update_whole", folder, Layer("imagery", {"path = \"world.tif\"", photo})));
}

TEST(Update, TheFinestStaysLastWhereTheSpecAskedForIt) {
  const std::string folder = FreshFolder("update_priority");
  Noise(folder + "/world.tif", 1, 128, 64, Degrees(-180, 90, 360.0 / 128), 1, 40);
  Noise(folder + "/fine.tif", 2, 60, 60, Degrees(10, 50, 0.01));
  Noise(folder + "/coarse.tif", 3, 60, 60, Degrees(10, 50, 0.03));
  const auto by_resolution = [](const std::vector<std::string>& sources) {
    std::string text = Layer("elevation", sources);
    return text.insert(text.find("kind"), "priority = \"resolution\"\n");
  };
  MustBuild(folder, by_resolution({"path = \"fine.tif\"", "path = \"world.tif\""}));
  ASSERT_TRUE(Add(folder, Layer("elevation", {"path = \"coarse.tif\""})).ok());
  ExpectSame(PagesOf(folder),
             BuiltWhole("update_whole", folder,
                        by_resolution({"path = \"fine.tif\"", "path = \"world.tif\"", "path = \"coarse.tif\""})));
}

TEST(Update, StepsAndNewLayers) {
  const std::string folder = FreshFolder("update_steps");
  Noise(folder + "/world.tif", 1, 128, 64, Degrees(-180, 90, 360.0 / 128), 3);
  Noise(folder + "/winter.tif", 2, 128, 64, Degrees(-180, 90, 360.0 / 128), 3);
  Noise(folder + "/inset.tif", 3, 30, 30, Degrees(10, 50, 0.05), 3);
  Noise(folder + "/heights.tif", 4, 128, 64, Degrees(-180, 90, 360.0 / 128));
  const std::string summer = "path = \"world.tif\"\ntime = \"2004-07-01\"";
  const std::string winter = "path = \"winter.tif\"\ntime = \"2004-01-01\"";
  const std::string inset = "path = \"inset.tif\"", late = inset + "\ntime = \"2004-07-01\"";
  MustBuild(folder, Layer("imagery", {winter, summer}));
  // Without a time it lies under all steps, with one over its own.
  ASSERT_TRUE(Add(folder, Layer("imagery", {inset})).ok());
  ExpectSame(PagesOf(folder), BuiltWhole("update_whole", folder, Layer("imagery", {inset, winter, summer})));
  ASSERT_TRUE(Add(folder, Layer("imagery", {late}) + Layer("elevation", {"path = \"heights.tif\""})).ok());
  ExpectSame(PagesOf(folder), BuiltWhole("update_whole", folder,
                                         Layer("imagery", {inset, winter, summer, late}) +
                                             Layer("elevation", {"path = \"heights.tif\""})));
  const auto other_time = Add(folder, Layer("imagery", {inset + "\ntime = \"2004-04-01\""}));
  ASSERT_FALSE(other_time.ok());
  EXPECT_NE(other_time.message().find("build the dataset again"), std::string::npos) << other_time.message();
}

TEST(Update, WhatCannotBeDoneIsSaidAndChangesNothing) {
  const std::string folder = FreshFolder("update_refused");
  Noise(folder + "/world.tif", 1, 128, 64, Degrees(-180, 90, 360.0 / 128), 1, 40);
  Noise(folder + "/cut.tif", 2, 300, 300, Degrees(10, 50, 0.02));
  fs::resize_file(folder + "/cut.tif", fs::file_size(folder + "/cut.tif") / 2);
  Write(folder + "/empty.tif", {.width = 9,
                                .height = 9,
                                .affine = Degrees(10, 50, 0.1),
                                .value = [](int, int, int) { return -1.0; },
                                .finish = [](GDALDataset& d) { d.GetRasterBand(1)->SetNoDataValue(-1); }});
  MustBuild(folder, Layer("elevation", {"path = \"world.tif\""}));
  const Pages before = PagesOf(folder);
  const auto refused = [&](const Result<BuildReport>& report, const std::string& part) {
    ASSERT_FALSE(report.ok()) << part;
    EXPECT_NE(report.message().find(part), std::string::npos) << report.message();
    ExpectSame(PagesOf(folder), before);
    EXPECT_FALSE(fs::exists(folder + "/out.partial"));
  };
  refused(Add(folder, Layer("elevation", {"path = \"missing.tif\""})), "missing.tif");
  refused(Add(folder, Layer("elevation", {"path = \"cut.tif\""})), "truncated");
  refused(Add(folder, Layer("elevation", {"path = \"empty.tif\""})), "covers nothing");
  refused(Add(folder, Layer("elevation", {"path = \"world.tif\""})), "already");
  refused(Remove(folder, "world.tif"), "without a source");
  refused(Remove(folder, "other.tif"), "no source");
  refused(Remove(folder, "world.tif", "imagery"), "imagery");
  fs::rename(folder + "/world.tif", folder + "/elsewhere.tif");
  refused(Refresh(folder), "world.tif");
}

}  // namespace
}  // namespace belvedere
