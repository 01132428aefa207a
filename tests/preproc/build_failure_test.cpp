// A build that is killed, and one that finds the disk full: the dataset that was there still opens.
//
// Each runs in a process of its own, forked before this one has a thread.

#include "tests/preproc/in_child.h"
#include "tests/preproc/made_raster.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <cstdio>
#include <filesystem>
#include <random>

namespace belvedere {
namespace {

using namespace testing_rasters;
namespace fs = std::filesystem;

Result<BuildReport> BuildFrom(const std::string& folder, const std::string& source) {
  const auto spec = ParseSpec(Layer("elevation", {"path = \"" + source + "\""}), folder + "/spec.toml");
  BuildOptions options;
  options.out = folder + "/out";
  options.jobs = 2;
  options.show_progress = false;
  return Build(*spec, options, Clock::System());
}

// A folder with a small dataset in it, and a source that makes hundreds of incompressible pages.
std::string Prepare(const std::string& name) {
  const std::string folder = FreshFolder(name);
  std::mt19937 random(1);
  Write(folder + "/small.tif",
        {.width = 8, .height = 4, .affine = Degrees(-180, 90, 45), .value = [](int, int, int) { return 7.0; }});
  Write(folder + "/large.tif",
        {.width = 2048, .height = 1024, .affine = Degrees(-180, 90, 360.0 / 2048), .value = [&](int, int, int) {
           return static_cast<double>(random() % 8000);
         }});
  EXPECT_TRUE(Succeeds([&] { return BuildFrom(folder, "small.tif").ok(); }));
  return folder;
}

void ExpectPrevious(const std::string& folder) {
  const auto dataset = Dataset::Open(folder + "/out");
  ASSERT_TRUE(dataset.ok()) << dataset.message();
  ASSERT_EQ((*dataset)->layers().size(), 1u);
  EXPECT_EQ((*dataset)->layers()[0].sources.at(0).path, "small.tif");
  for (int tree = 0; tree < kTrees; ++tree) EXPECT_TRUE((*dataset)->ReadElevation(0, Quadcode::Root(tree)).ok());
}

TEST(BuildFailure, AKilledBuildLeavesThePreviousDataset) {
  const std::string folder = Prepare("killed");
  const fs::path partial = folder + "/out.partial/data.mdb";
  std::error_code error;
  const auto far_enough = [&] {
    return fs::exists(partial, error) && fs::file_size(partial, error) >= (size_t{1} << 22);
  };
  ASSERT_TRUE(IsKilledWhen(far_enough, [&] { static_cast<void>(BuildFrom(folder, "large.tif").ok()); }));
  EXPECT_TRUE(fs::exists(folder + "/out.partial"));
  ExpectPrevious(folder);
  // And the next build clears away what was left.
  EXPECT_TRUE(Succeeds([&] { return BuildFrom(folder, "small.tif").ok(); }));
  EXPECT_FALSE(fs::exists(folder + "/out.partial"));
  ExpectPrevious(folder);
}

TEST(BuildFailure, AFullDiskIsSaidAndLeavesThePreviousDataset) {
  const std::string folder = Prepare("full");
  const int status = InChild([&] {
    // No file may grow past 2 MiB: writing fails as it does where the disk ends.
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{rlim_t{2} << 20, rlim_t{2} << 20};
    if (setrlimit(RLIMIT_FSIZE, &limit) != 0) return 2;
    const auto report = BuildFrom(folder, "large.tif");
    if (report.ok()) return 3;
    std::fprintf(stderr, "%s\n", report.message().c_str());
    return report.message().find("disk is full") != std::string::npos &&
                   report.message().find("unchanged") != std::string::npos
               ? 0
               : 4;
  });
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
  EXPECT_FALSE(fs::exists(folder + "/out.partial"));
  ExpectPrevious(folder);
}

}  // namespace
}  // namespace belvedere
