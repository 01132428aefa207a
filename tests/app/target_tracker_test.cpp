#include "runtime/app/target_tracker.h"

#include "runtime/app/catalogue_file.h"
#include "runtime/earth/ellipsoid.h"

#include <gtest/gtest.h>
#include <unistd.h>
#include <glm/geometric.hpp>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

namespace belvedere {
namespace {

const GroundHeight kSea = [](double, double) { return 0.0; };

ObjectRecord Flying(uint16_t entity, const Geodetic& place, const glm::dvec3& velocity_mps) {
  ObjectRecord object;
  object.id = {1, 1, entity};
  object.type.kind = EntityType::kPlatform;
  object.type.domain = EntityType::kAir;
  object.kinematics.position_ecef = ToEcef(place);
  object.kinematics.velocity_mps = velocity_mps;
  object.kinematics.model = DeadReckoning::kFpw;
  object.kinematics.time_s = 10;
  object.report = 1;
  return object;
}

TEST(TargetTrackerTest, FollowsAlongTheDeadReckonedPath) {
  ObjectSnapshot snapshot;
  const glm::dvec3 velocity{0, 0, 100};
  snapshot.objects = {Flying(4, {37, -118, 5'000}, velocity)};
  TargetTracker tracker;
  const TargetRule rule = *ParseTargetRule("first air");
  const auto pose = tracker.Follow("first air", rule, {}, snapshot, 12, kSea);
  ASSERT_TRUE(pose.has_value());
  EXPECT_LT(glm::distance(pose->position_ecef, snapshot.objects[0].kinematics.position_ecef + 2.0 * velocity), 1e-6);
  EXPECT_EQ(tracker.IdOf("first air")->entity, 4);
}

TEST(TargetTrackerTest, KeepsItsObjectAndTakesAnotherWhenItIsGone) {
  ObjectSnapshot snapshot;
  snapshot.objects = {Flying(4, {37, -118, 5'000}, {}), Flying(7, {37, -118, 6'000}, {})};
  TargetTracker tracker;
  const TargetRule rule = *ParseTargetRule("first air");
  tracker.Follow("r", rule, {}, snapshot, 10, kSea);
  snapshot.objects.insert(snapshot.objects.begin(), Flying(1, {37, -118, 7'000}, {}));
  tracker.Follow("r", rule, {}, snapshot, 11, kSea);
  EXPECT_EQ(tracker.IdOf("r")->entity, 4);
  tracker.Cycle("r", snapshot, 1);
  EXPECT_EQ(tracker.IdOf("r")->entity, 7);
  snapshot.objects.pop_back();
  tracker.Follow("r", rule, {}, snapshot, 12, kSea);
  EXPECT_EQ(tracker.IdOf("r")->entity, 1);
  snapshot.objects.clear();
  EXPECT_FALSE(tracker.Follow("r", rule, {}, snapshot, 13, kSea).has_value());
}

TEST(TargetTrackerTest, GroundVehiclesStandOnTheGround) {
  ObjectSnapshot snapshot;
  ObjectRecord truck = Flying(4, {37, -118, 100}, {});
  truck.type.domain = EntityType::kLand;
  snapshot.objects = {truck};
  TargetTracker tracker;
  const GroundHeight hill = [](double, double) { return 1'234.0; };
  const auto pose = tracker.Follow("r", *ParseTargetRule("first ground"), {}, snapshot, 10, hill);
  ASSERT_TRUE(pose.has_value());
  EXPECT_NEAR(ToGeodetic(pose->position_ecef).height_m, 1'234, 1e-6);
}

TEST(CatalogueFileTest, ProjectsOwnCatalogueKnowsItsModels) {
  const std::string folder = std::string(BELVEDERE_SOURCE_DIR) + "/servers/models";
  const Result<Catalogue> catalogue = LoadCatalogue(folder);
  ASSERT_TRUE(catalogue.ok()) << catalogue.message();
  for (const ModelEntry& entry : catalogue->models.entries()) {
    EXPECT_TRUE(std::filesystem::exists(folder + "/" + entry.name + ".gltf")) << entry.name;
    EXPECT_GT(entry.length_m, 1);
  }
  EntityType airliner;
  airliner.kind = EntityType::kPlatform;
  airliner.domain = EntityType::kAir;
  airliner.country = 225;
  airliner.category = 57;
  const EntityLook look = catalogue->looks.LookOf(airliner);
  EXPECT_EQ(look.model, catalogue->models.Find("airliner"));
  EXPECT_EQ(look.symbol, SymbolShape::kAir);
}

TEST(CatalogueFileTest, SaysWhatIsWrong) {
  EXPECT_NE(LoadCatalogue("/nowhere").message().find("/nowhere/catalogue.toml"), std::string::npos);
  const std::string folder = testing::TempDir() + "belvedere_catalogue_" + std::to_string(getpid());
  std::filesystem::create_directories(folder);
  std::ofstream(folder + "/catalogue.toml")
      << "[[model]]\nname = \"x\"\nlength_m = 3\nsymbol = \"plane\"\nentity_types = [\"1.2\"]\n";
  EXPECT_NE(LoadCatalogue(folder).message().find("catalogue.toml:4: model.symbol is \"plane\""), std::string::npos);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace belvedere
