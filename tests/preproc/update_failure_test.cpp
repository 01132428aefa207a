// A change that is killed, or finds the disk full, leaves the dataset as it was. By itself: the builds that are killed
// are processes of their own, forked before this one has a thread.

#include "tests/preproc/changed_dataset.h"
#include "tests/preproc/in_child.h"

#include <sys/resource.h>

#include <csignal>

namespace belvedere {
namespace {

using namespace testing_rasters;

TEST(UpdateFailure, KilledOrOnAFullDiskItLeavesTheDatasetAsItWas) {
  const std::string folder = FreshFolder("update_killed");
  Noise(folder + "/world.tif", 1, 128, 64, Degrees(-180, 90, 360.0 / 128), 1, 40);
  Noise(folder + "/large.tif", 2, 1200, 1200, Degrees(10, 50, 0.01));
  const std::string large = Layer("elevation", {"path = \"large.tif\""});
  ASSERT_TRUE(Succeeds([&] {
    MustBuild(folder, Layer("elevation", {"path = \"world.tif\""}));
    return Dataset::Open(folder + "/out").ok();
  }));
  const fs::path partial = folder + "/out.partial/data.mdb";
  std::error_code error;
  const auto far_enough = [&] { return fs::exists(partial, error) && fs::file_size(partial, error) > (1 << 21); };
  ASSERT_TRUE(IsKilledWhen(far_enough, [&] { static_cast<void>(Add(folder, large).ok()); }));
  const int status = InChild([&] {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{rlim_t{2} << 20, rlim_t{2} << 20};
    if (setrlimit(RLIMIT_FSIZE, &limit) != 0) return 2;
    const auto report = Add(folder, large);
    return !report.ok() && report.message().find("disk is full") != std::string::npos ? 0 : 3;
  });
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  EXPECT_FALSE(fs::exists(folder + "/out.partial"));
  const Pages before = PagesOf(folder);
  EXPECT_EQ(MustOpen(folder)->layers()[0].sources.size(), 1u);
  ASSERT_TRUE(Add(folder, large).ok());
  ASSERT_TRUE(Remove(folder, "large.tif").ok());
  ExpectSame(PagesOf(folder), before);
}

}  // namespace
}  // namespace belvedere
