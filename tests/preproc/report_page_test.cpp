#include "preproc/report_page.h"

#include "preproc/markup.h"
#include "tests/preproc/made_raster.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <numeric>
#include <regex>

namespace belvedere {
namespace {

using namespace testing_rasters;
namespace fs = std::filesystem;

void ExpectHas(const std::string& page, const std::string& part) {
  EXPECT_NE(page.find(part), std::string::npos) << part;
}

// Heights with a source that is missing and one that is hidden, imagery of two times.
struct Built {
  BuildReport report;
  std::unique_ptr<Dataset> dataset;
};
Built BuildAll(const std::string& folder) {
  const auto value = [](int band, int column, int row) { return 10.0 * band + (column + row) % 100; };
  MadeRaster made{.width = 360, .height = 180, .affine = Degrees(-180, 90, 1), .value = value};
  Write(folder + "/heights.tif", made);
  Write(folder + "/over.tif", made);
  made.type = GDT_Byte;
  Write(folder + "/colours.tif", made);
  const std::string spec = Layer("elevation", {"path = \"heights.tif\"", "path = \"gone<script>.tif\"",
                                               "path = \"over.tif\"\ndatum = -12.5\nnodata = -7"}) +
                           "[[layer]]\nname = \"sea & sons\"\nkind = \"imagery\"\n"
                           "[[layer.source]]\npath = \"colours.tif\"\ntime = \"2004-01-01\"\n"
                           "[[layer.source]]\npath = \"colours.tif\"\ntime = \"2005-01-01\"\n";
  BuildReport report = MustBuild(folder, spec);
  return {std::move(report), MustOpen(folder)};
}

TEST(ReportPage, SaysWhatWasBuiltFromWhatAndWhatWasNot) {
  const std::string folder = FreshFolder("page");
  const Built built = BuildAll(folder);
  const auto page = ReportPage(*built.dataset, built.report);
  ASSERT_TRUE(page.ok()) << page.message();
  ExpectHas(*page, "<h1>Dataset out</h1>");
  ExpectHas(*page, built.dataset->build_time());
  ExpectHas(*page, "<td>heights.tif</td><td>EPSG:4326</td><td>egm96</td>");
  ExpectHas(*page, "<td>over.tif</td><td>EPSG:4326</td><td>-12.5");
  ExpectHas(*page, "<td>-7</td>");
  ExpectHas(*page, "Sources that were skipped");
  ExpectHas(*page, "<td>gone&lt;script&gt;.tif</td>");
  ExpectHas(*page, "Warnings");
  ExpectHas(*page, "<td>heights.tif</td><td>nothing of it is seen");
  ExpectHas(*page, "mean sea level lifted by");
  ExpectHas(*page, "<h2>sea &amp; sons</h2><p>imagery, 2 times: 64 pages");
  ExpectHas(*page, "from 2005-01-01T00:00:00Z");
  for (const LayerRecord& layer : built.dataset->layers()) EXPECT_EQ(layer.pages_per_level.at(0), 32);
  EXPECT_EQ(page->find("nothing to warn of"), std::string::npos);
}

// Whoever opens it fetches nothing and runs nothing, whatever a spec said.
TEST(ReportPage, IsWholeInItself) {
  const std::string folder = FreshFolder("page_whole");
  const Built built = BuildAll(folder);
  const auto page = ReportPage(*built.dataset, built.report);
  ASSERT_TRUE(page.ok()) << page.message();
  EXPECT_EQ(page->find("<script"), std::string::npos);
  EXPECT_EQ(page->find("url("), std::string::npos);
  EXPECT_EQ(page->find("http://"), std::string::npos);
  EXPECT_EQ(page->find("https://"), std::string::npos);
  ExpectHas(*page, "default-src 'none'");
  const std::regex references("(src|href)=\"([^\"]{0,20})");
  int pictures = 0;
  for (std::sregex_iterator found(page->begin(), page->end(), references), end; found != end; ++found, ++pictures)
    EXPECT_EQ((*found)[2].str().rfind("data:image/", 0), 0u) << (*found)[2];
  EXPECT_GE(pictures, 1 + 1 + 2 + 1) << "a picture of each layer and time, and a map of each layer";
  EXPECT_LT(page->size(), 1'000'000u);
}

TEST(ReportPage, BytesOfLevelsAddUpToTheLayers) {
  const std::string folder = FreshFolder("page_bytes");
  const Built built = BuildAll(folder);
  const auto page = ReportPage(*built.dataset, built.report);
  ASSERT_TRUE(page.ok()) << page.message();
  for (size_t layer = 0; layer < built.dataset->layers().size(); ++layer) {
    const auto number = static_cast<int>(layer);
    std::vector<int64_t> bytes(1 + static_cast<size_t>(built.dataset->MaxLevel(number)));
    for (const uint64_t word : built.dataset->Nodes(number)) {
      const Quadcode node = *Quadcode::FromWord(word);
      bytes[static_cast<size_t>(node.level())] += built.dataset->StoredBytes(number, node);
    }
    const LayerRecord& record = built.dataset->layers()[layer];
    EXPECT_EQ(std::accumulate(bytes.begin(), bytes.end(), int64_t{0}), record.bytes);
    if (record.step) continue;  // the page counts all steps together
    for (size_t level = 0; level < bytes.size(); ++level) {
      ExpectHas(*page, fmt::format("<td class=\"n\">{}</td><td class=\"n\">{}</td>",
                                   markup::Count(record.pages_per_level[level]), markup::Bytes(bytes[level])));
    }
  }
  EXPECT_EQ(built.dataset->StoredBytes(0, Quadcode::Containing(0, 0, kMaxLevel)), 0) << "no such page";
}

TEST(ReportPage, ManySourcesAndRemarksAreCountedNotListed) {
  const std::string folder = FreshFolder("page_many");
  Built built = BuildAll(folder);
  built.report.warnings.clear();
  for (int i = 0; i < 5000; ++i) built.report.warnings.push_back({fmt::format("file-{}", i), std::string(200, 'x')});
  const auto page = ReportPage(*built.dataset, built.report);
  ASSERT_TRUE(page.ok()) << page.message();
  EXPECT_LT(page->size(), 1'000'000u);
  ExpectHas(*page, "And 4,700 more sources");
}

TEST(ReportPage, IsWrittenBesideItsPlaceAndMovedThere) {
  const std::string folder = FreshFolder("page_written");
  const Built built = BuildAll(folder);
  const std::string path = ReportPathIn(folder + "/out");
  EXPECT_EQ(path, folder + "/out/report.html");
  ASSERT_TRUE(WriteReportPage(*built.dataset, built.report, path).ok());
  std::ifstream file(path);
  const std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  EXPECT_EQ(text.rfind("<!DOCTYPE html>", 0), 0u);
  EXPECT_EQ(text.substr(text.size() - 8), "</html>\n");
  EXPECT_FALSE(fs::exists(path + ".partial"));
  const Status refused = WriteReportPage(*built.dataset, built.report, folder + "/none/report.html");
  EXPECT_NE(refused.message().find("check the folder"), std::string::npos) << refused.message();
}

}  // namespace
}  // namespace belvedere
