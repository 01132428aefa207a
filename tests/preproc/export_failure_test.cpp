// An export that finds the disk full: it says so, and the file that was there is as it was.
//
// Each runs in a process of its own, forked before this one has a thread.

#include "preproc/export.h"
#include "tests/preproc/made_raster.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <optional>
#include <random>

namespace belvedere {
namespace {

using namespace testing_rasters;
namespace fs = std::filesystem;

int ExitOf(const std::function<int()>& body) {
  const pid_t child = fork();
  if (child == 0) _exit(body());
  int status = 0;
  EXPECT_EQ(waitpid(child, &status, 0), child);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

// No file may grow past kibibytes.
void ExpectFullDiskIsSaid(const std::string& layer, const std::string& name, rlim_t kibibytes,
                          std::optional<GeoBox> extent = std::nullopt) {
  const std::string folder = FreshFolder("export_full_" + layer + name);
  const std::string out = folder + "/" + name;
  ASSERT_EQ(ExitOf([&] {
              std::mt19937 random(3);
              Write(folder + "/noise.tif",
                    {.width = 720,
                     .height = 360,
                     .type = GDT_Byte,
                     .affine = Degrees(-180, 90, 0.5),
                     .value = [&](int, int, int) { return static_cast<double>(random() % 256); }});
              return MustBuild(folder, Layer(layer, {"path = \"noise.tif\""})).pages > 0 ? 0 : 1;
            }),
            0);
  std::ofstream(out) << "what was there";
  EXPECT_EQ(ExitOf([&] {
              // Writing fails as it does where the disk ends.
              std::signal(SIGXFSZ, SIG_IGN);
              const rlimit limit{kibibytes << 10, kibibytes << 10};
              if (setrlimit(RLIMIT_FSIZE, &limit) != 0) return 2;
              const auto dataset = Dataset::Open(folder + "/out");
              if (!dataset.ok()) return 3;
              const auto report = Export(
                  **dataset, {.layer = layer, .out = out, .extent = extent, .show_progress = false}, Clock::System());
              if (report.ok()) return 4;
              std::fprintf(stderr, "%s\n", report.message().c_str());
              return report.message().find("check the space on the disk") != std::string::npos ? 0 : 5;
            }),
            0);
  EXPECT_EQ(fs::file_size(out), 14u);
  EXPECT_FALSE(fs::exists(out + ".partial"));
}

TEST(ExportFailure, AFullDiskIsSaidOfHeights) {
  ExpectFullDiskIsSaid("elevation", "a.tif", 256);
}
TEST(ExportFailure, AFullDiskIsSaidOfImagery) {
  ExpectFullDiskIsSaid("imagery", "a.tif", 256);
}
TEST(ExportFailure, AFullDiskIsSaidOfTiles) {
  ExpectFullDiskIsSaid("imagery", "a.mbtiles", 256);
}
// So small a file that nothing is written before it is closed.
TEST(ExportFailure, AFullDiskIsSaidWhereOnlyClosingFindsIt) {
  ExpectFullDiskIsSaid("imagery", "a.tif", 1, GeoBox{1, 1, 9, 9});
  ExpectFullDiskIsSaid("elevation", "a.tif", 1, GeoBox{1, 1, 9, 9});
  ExpectFullDiskIsSaid("imagery", "a.mbtiles", 16, GeoBox{1, 1, 9, 9});
}

}  // namespace
}  // namespace belvedere
