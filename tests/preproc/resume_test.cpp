// A build that was killed is gone on with, and makes what it would have made; what is of other sources is thrown away.

#include "preproc/report.h"
#include "tests/preproc/in_child.h"
#include "tests/preproc/made_raster.h"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <random>

namespace belvedere {
namespace {

using namespace testing_rasters;
namespace fs = std::filesystem;

Result<BuildReport> BuildIn(const std::string& folder, const std::string& text, const std::string& out,
                            bool fresh = false) {
  const auto spec = ParseSpec(text, folder + "/spec.toml");
  BuildOptions options;
  options.out = folder + "/" + out;
  options.jobs = 2;
  options.batch_bytes = 1 << 16;
  options.fresh = fresh;
  options.show_progress = false;
  return Build(*spec, options, Clock::System());
}

std::string Spec() {
  return Layer("elevation", {"path = \"heights.tif\""}) + Layer("imagery", {"path = \"colours.tif\""});
}

// Sources of hundreds of pages.
std::string Prepare(const std::string& name) {
  const std::string folder = FreshFolder(name);
  std::mt19937 random(1);
  Write(folder + "/heights.tif",
        {.width = 512, .height = 256, .affine = Degrees(-180, 90, 360.0 / 512), .value = [&](int, int, int) {
           return static_cast<double>(random() % 8000);
         }});
  // And a place of many levels, so that deviations are kept.
  Write(folder + "/inset.tif", {.width = 64, .height = 64, .affine = Degrees(9, 21, 0.02), .value = [&](int, int, int) {
                                  return static_cast<double>(random() % 3000);
                                }});
  Write(folder + "/colours.tif", {.width = 1024,
                                  .height = 512,
                                  .bands = 3,
                                  .type = GDT_Byte,
                                  .affine = Degrees(-180, 90, 360.0 / 1024),
                                  .value = [&](int, int, int) { return static_cast<double>(random() % 256); }});
  return folder;
}

uintmax_t PartialBytes(const std::string& folder) {
  std::error_code error;
  const uintmax_t bytes = fs::file_size(folder + "/out.partial/data.mdb", error);
  return error ? 0 : bytes;
}

bool IsKilledAt(const std::string& folder, const std::string& text, uintmax_t bytes) {
  return IsKilledWhen([&] { return PartialBytes(folder) >= bytes; },
                      [&] { static_cast<void>(BuildIn(folder, text, "out").ok()); });
}

uint32_t DigestOf(const std::string& folder, const std::string& out) {
  const auto dataset = Dataset::Open(folder + "/" + out);
  EXPECT_TRUE(dataset.ok()) << dataset.message();
  const Verification found = VerifyDataset(**dataset);
  EXPECT_TRUE(found.problems.empty());
  return found.digest;
}

// How many pages the next build takes over, or -1 where it fails.
int64_t Resumed(const std::string& folder, const std::string& text, bool fresh = false) {
  int channel[2];
  EXPECT_EQ(pipe(channel), 0);
  InChild([&] {
    const auto report = BuildIn(folder, text, "out", fresh);
    const int64_t resumed = report.ok() ? report->resumed : -1;
    return write(channel[1], &resumed, sizeof(resumed)) == sizeof(resumed) ? 0 : 1;
  });
  int64_t resumed = -2;
  EXPECT_EQ(read(channel[0], &resumed, sizeof(resumed)), static_cast<ssize_t>(sizeof(resumed)));
  close(channel[0]);
  close(channel[1]);
  return resumed;
}

TEST(Resume, AKilledBuildGoesOnToTheSamePages) {
  const std::string folder = Prepare("resume_same");
  const std::string spec = Layer("elevation", {"path = \"heights.tif\"", "path = \"inset.tif\""}) +
                           Layer("imagery", {"path = \"colours.tif\""});
  ASSERT_TRUE(Succeeds([&] { return BuildIn(folder, spec, "whole").ok(); }));
  const uintmax_t whole_bytes = fs::file_size(folder + "/whole/data.mdb");
  // Killed again and again, each time further on.
  for (const uintmax_t tenths : {2U, 4U, 6U, 8U}) ASSERT_TRUE(IsKilledAt(folder, spec, whole_bytes * tenths / 10));
  EXPECT_FALSE(fs::exists(folder + "/out"));
  const int64_t resumed = Resumed(folder, spec);
  const auto whole = Dataset::Open(folder + "/whole");
  ASSERT_TRUE(whole.ok());
  const auto pages = static_cast<int64_t>((*whole)->Nodes(0).size() + (*whole)->Nodes(1).size());
  EXPECT_GT(resumed, pages / 2);
  EXPECT_LT(resumed, pages);
  EXPECT_EQ(DigestOf(folder, "out"), DigestOf(folder, "whole"));
  const auto gone_on = Dataset::Open(folder + "/out");
  ASSERT_TRUE(gone_on.ok());
  for (const uint64_t word : (*whole)->Nodes(0)) {
    const Quadcode node = *Quadcode::FromWord(word);
    EXPECT_EQ((*gone_on)->ReadDeviations(0, node), (*whole)->ReadDeviations(0, node)) << node.ToString();
  }
  EXPECT_FALSE(fs::exists(folder + "/out.partial"));
}

TEST(Resume, NothingIsTakenOverOfAnotherSpec) {
  const std::string folder = Prepare("resume_spec");
  ASSERT_TRUE(IsKilledAt(folder, Spec(), 2 << 20));
  EXPECT_EQ(Resumed(folder, Layer("elevation", {"path = \"heights.tif\"\nunit = \"ft\""}) +
                                Layer("imagery", {"path = \"colours.tif\""})),
            0);
}

TEST(Resume, NothingIsTakenOverOfASourceThatHasChanged) {
  const std::string folder = Prepare("resume_source");
  ASSERT_TRUE(IsKilledAt(folder, Spec(), 2 << 20));
  const fs::path source = folder + "/heights.tif";
  fs::last_write_time(source, fs::last_write_time(source) + std::chrono::milliseconds(1));
  EXPECT_EQ(Resumed(folder, Spec()), 0);
}

TEST(Resume, NothingIsTakenOverOfASourceWhoseWorldFileHasChanged) {
  const std::string folder = Prepare("resume_world_file");
  std::ofstream(folder + "/bare.pgm") << "P5\n256 128\n255\n" << std::string(256 * 128, 'x');
  const auto write_world_file = [&](const char* west) {
    std::ofstream(folder + "/bare.wld") << "1.40625\n0\n0\n-1.40625\n" << west << "\n89.296875\n";
  };
  write_world_file("-179.296875");
  const std::string spec = Spec() + Layer("imagery2", {"path = \"bare.pgm\"\ncrs = \"EPSG:4326\""});
  std::string text = spec;
  text.replace(text.rfind("kind = \"imagery2\""), 17, "kind = \"imagery\"");
  ASSERT_TRUE(IsKilledAt(folder, text, 2 << 20));
  write_world_file("-178.296875");
  EXPECT_EQ(Resumed(folder, text), 0);
}

TEST(Resume, FreshStartsOver) {
  const std::string folder = Prepare("resume_fresh");
  ASSERT_TRUE(IsKilledAt(folder, Spec(), 2 << 20));
  EXPECT_EQ(Resumed(folder, Spec(), true), 0);
}

// What was left out stays so, and nothing that was made with it is taken over.
TEST(Resume, ABuildThatHadStartedOverWithoutASourceGoesOn) {
  const std::string folder = Prepare("resume_rounds");
  fs::copy(folder + "/heights.tif", folder + "/cut.tif");
  fs::resize_file(folder + "/cut.tif", fs::file_size(folder + "/cut.tif") * 7 / 8);
  const std::string spec = Layer("elevation", {"path = \"heights.tif\"", "path = \"cut.tif\""}) +
                           Layer("imagery", {"path = \"colours.tif\""});
  ASSERT_TRUE(Succeeds([&] { return BuildIn(folder, spec, "whole").ok(); }));
  // Once more is written than was there with the note, which then is sure to count.
  uintmax_t noted_bytes = 0;
  const auto started_over = [&] {
    if (noted_bytes > 0) return PartialBytes(folder) > noted_bytes;
    std::ifstream file(folder + "/out.partial/data.mdb", std::ios::binary);
    std::string bytes(PartialBytes(folder), 0);
    file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    if (bytes.find("\"skipped\":{\"elevation") != std::string::npos) noted_bytes = PartialBytes(folder);
    return false;
  };
  ASSERT_TRUE(IsKilledWhen(started_over, [&] { static_cast<void>(BuildIn(folder, spec, "out").ok()); }));
  EXPECT_GT(Resumed(folder, spec), 0);
  EXPECT_EQ(DigestOf(folder, "out"), DigestOf(folder, "whole"));
  EXPECT_EQ((*Dataset::Open(folder + "/out"))->layers()[0].sources.size(), 1u);
}

TEST(Resume, WhatWasSeenBeforeTheKillIsNotWarnedOf) {
  const std::string folder = Prepare("resume_seen");
  ASSERT_TRUE(IsKilledAt(folder, Spec(), 2 << 20));
  EXPECT_TRUE(Succeeds([&] {
    const auto report = BuildIn(folder, Spec(), "out");
    return report.ok() && report->resumed > 0 && report->warnings.empty();
  }));
}

}  // namespace
}  // namespace belvedere
