// Layers that are made of another's pages: in a build, in changes, and after a build was killed.

#include "preproc/types/surface_properties.h"
#include "tests/preproc/changed_dataset.h"
#include "tests/preproc/declared_types.h"

#include <fstream>
#include <set>

namespace belvedere {
namespace {

using namespace testing_rasters;
using testing_types::kSteepType;

const char* const kAngles = "[[layer]]\nname = \"angles\"\nkind = \"slope angle\"\n";
const char* const kSteep = "[[layer]]\nname = \"steep\"\nkind = \"steep\"\nof = \"angles\"\n";

std::string Prepare(const std::string& name) {
  const std::string folder = FreshFolder(name);
  Noise(folder + "/world.tif", 1, 128, 64, Degrees(-180, 90, 360.0 / 128), 1, 40);
  Noise(folder + "/inset.tif", 2, 40, 30, Degrees(11.2, 47.9, 0.01));
  return folder;
}
std::string Heights(const std::vector<std::string>& names) {
  std::vector<std::string> sources;
  for (const std::string& name : names) sources.push_back("path = \"" + name + "\"");
  return Layer("elevation", sources);
}

TEST(DerivedLayers, HaveAPageForEachOfTheOthers) {
  const std::string folder = Prepare("derived_pages");
  MustBuild(folder, kSteepType + Heights({"world.tif", "inset.tif"}) + kAngles + kSteep);
  const auto dataset = MustOpen(folder);
  ASSERT_EQ(dataset->layers().size(), 3U);
  EXPECT_EQ(dataset->layers()[1].kind, LayerKind::kProperty);
  EXPECT_EQ(dataset->layers()[1].derivation->of, "elevation");
  EXPECT_EQ(dataset->layers()[1].property->unit, "deg");
  EXPECT_EQ(dataset->layers()[2].property->classes[1].name, "yes");
  EXPECT_TRUE(VerifyDataset(*dataset).problems.empty());
  int64_t steep = 0;
  for (const uint64_t word : dataset->Nodes(0)) {
    const Quadcode node = *Quadcode::FromWord(word);
    const auto heights = dataset->ReadElevation(0, node);
    const auto angles = dataset->ReadProperty(1, node);
    const auto classes = dataset->ReadProperty(2, node);
    ASSERT_TRUE(heights.ok() && angles.ok() && classes.ok()) << node.ToString();
    ASSERT_EQ((*angles)->values, SlopeAngles(**heights, node)->values) << node.ToString();
    for (size_t i = 0; i < (*angles)->values.size(); ++i) {
      const bool is_steep = (*angles)->values[i] >= 40;
      ASSERT_EQ((*classes)->values[i], is_steep ? 1 : 0);
      steep += is_steep;
    }
  }
  EXPECT_GT(steep, 0);
  EXPECT_EQ(dataset->Nodes(1).size(), dataset->Nodes(0).size());
}

TEST(DerivedLayers, FollowChangesOfWhatTheyAreMadeOf) {
  const std::string folder = Prepare("derived_changes");
  const std::string more = std::string(kAngles) + kSteep;
  MustBuild(folder, kSteepType + Heights({"world.tif"}) + more);
  const Pages before = PagesOf(folder);
  const auto added = Add(folder, Heights({"inset.tif"}));
  ASSERT_TRUE(added.ok()) << added.message();
  const Pages after = PagesOf(folder);
  ExpectSame(after, BuiltWhole("derived_whole", folder, kSteepType + Heights({"world.tif", "inset.tif"}) + more));
  EXPECT_EQ(added->written, CountNew(before, after)) << "only what differs is written";
  ASSERT_TRUE(Remove(folder, "inset.tif").ok());
  ExpectSame(PagesOf(folder), before);
}

TEST(DerivedLayers, ComeToADatasetThatIsThere) {
  const std::string folder = Prepare("derived_added");
  MustBuild(folder, Heights({"world.tif", "inset.tif"}));
  const auto added = Add(folder, "[[layer]]\nname = \"angles\"\nkind = \"slope angle\"\nof = \"elevation\"\n");
  ASSERT_TRUE(added.ok()) << added.message();
  ASSERT_TRUE(Add(folder, std::string(kSteepType) + kSteep).ok());
  ExpectSame(PagesOf(folder),
             BuiltWhole("derived_whole", folder, kSteepType + Heights({"world.tif", "inset.tif"}) + kAngles + kSteep));
  EXPECT_NE(Add(folder, std::string(kSteepType) + kSteep).message().find("there already"), std::string::npos);
  EXPECT_NE(
      Add(folder, "[[layer]]\nname = \"x\"\nkind = \"roughness\"\nof = \"none\"\n").message().find("no layer none"),
      std::string::npos);
}

// A byte of roughness is a quarter of a metre, one of slope half a degree: limits are in the unit of what is classed.
TEST(DerivedLayers, ClassesTakeTheUnitOfTheirParent) {
  const std::string folder = Prepare("derived_units");
  const std::string rough = R"([[type]]
name = "rough"
parent = "roughness"
meta = "surface property"
read = "property pages"
process = [{ module = "classes", limits = [2.5, 30] }]
write = "property pages"
classes = [{ name = "a", colour = "#000000" }, { name = "b", colour = "#808080" }, { name = "c", colour = "#ffffff" }]
)";
  MustBuild(folder, rough + Heights({"inset.tif"}) +
                        "[[layer]]\nname = \"r\"\nkind = \"roughness\"\n[[layer]]\nname = \"c\"\nkind = \"rough\"\n");
  const auto dataset = MustOpen(folder);
  std::set<int> seen;
  for (const uint64_t word : dataset->Nodes(1)) {
    const Quadcode node = *Quadcode::FromWord(word);
    const auto metres = dataset->ReadProperty(1, node);
    const auto classes = dataset->ReadProperty(2, node);
    ASSERT_TRUE(metres.ok() && classes.ok());
    for (size_t i = 0; i < (*metres)->values.size(); ++i) {
      const double value_m = (*metres)->values[i] / 4.0;
      ASSERT_EQ((*classes)->values[i], (value_m >= 2.5) + (value_m >= 30));
      seen.insert((*classes)->values[i]);
    }
  }
  EXPECT_EQ(seen.size(), 3U);
}

TEST(DerivedLayers, AreLeftOutWithWhatTheyAreMadeOf) {
  const std::string folder = Prepare("derived_left_out");
  std::ofstream(folder + "/bad.tif") << "no raster";
  Noise(folder + "/colours.tif", 3, 64, 32, Degrees(-180, 90, 360.0 / 64), 3);
  const BuildReport report =
      MustBuild(folder, Heights({"bad.tif"}) + Layer("imagery", {"path = \"colours.tif\""}) + kAngles);
  ASSERT_EQ(report.layers.size(), 1U);
  ASSERT_EQ(report.skipped.size(), 2U);
  EXPECT_EQ(report.skipped[1].source, "angles");
}

}  // namespace
}  // namespace belvedere
