#include "runtime/earth/geoid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <fstream>

namespace belvedere {
namespace {

TEST(Geoid, AgreesWithNgaTestValues) {
  const auto geoid = Geoid::LoadEgm96();
  if (!geoid.ok()) GTEST_SKIP() << geoid.message();
  // Latitude, longitude, undulation: the sample output that NGA distributes with its EGM96 program.
  constexpr double kKnown[][3] = {{38.6281550, 269.7791550, -31.628}, {-14.6212170, 305.0211140, -2.969},
                                  {46.8743190, 102.4487290, -43.575}, {-23.6174460, 133.8747120, 15.871},
                                  {38.6254730, 359.9995000, 50.066},  {-0.4667440, 0.0023000, 17.329}};
  for (const auto& [latitude, longitude, undulation] : kKnown) {
    EXPECT_NEAR((*geoid)->Height(latitude, longitude), undulation, 0.3) << latitude << " " << longitude;
  }
}

TEST(Geoid, TurnsAndSeamMakeNoDifference) {
  const auto geoid = Geoid::LoadEgm96();
  if (!geoid.ok()) GTEST_SKIP() << geoid.message();
  EXPECT_NEAR((*geoid)->Height(10, 30), (*geoid)->Height(10, 390), 1e-9);
  EXPECT_NEAR((*geoid)->Height(10, -1e-9), (*geoid)->Height(10, 1e-9), 1e-6);
  EXPECT_NEAR((*geoid)->Height(10, 180), (*geoid)->Height(10, -180), 1e-9);
  EXPECT_TRUE(std::isfinite((*geoid)->Height(90, 0)));
  EXPECT_TRUE(std::isfinite((*geoid)->Height(-90, 359.99)));
}

TEST(Geoid, BadFilesAreRefused) {
  EXPECT_FALSE(Geoid::Load("/nonexistent/geoid.gtx").ok());
  const std::string path = testing::TempDir() + "/short.gtx";
  std::ofstream(path, std::ios::binary) << std::string(60, 'x');
  const auto geoid = Geoid::Load(path);
  EXPECT_FALSE(geoid.ok());
  EXPECT_NE(geoid.message().find("short.gtx"), std::string::npos);
  std::remove(path.c_str());
}

}  // namespace
}  // namespace belvedere
