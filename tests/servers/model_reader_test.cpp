#include "servers/model_reader.h"

#include <gtest/gtest.h>

#include <array>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <tuple>

namespace belvedere {
namespace {

const std::string kModels = std::string(BELVEDERE_SOURCE_DIR) + "/servers/models";
constexpr const char* kNames[] = {"airliner", "light_aircraft", "helicopter", "fighter", "truck",
                                  "car",      "tank",           "ship"};

std::string TemporaryFile(const std::string& name, const std::string& text) {
  const std::string path = testing::TempDir() + "belvedere_" + name;
  std::ofstream(path) << text;
  return path;
}

using Corner = std::tuple<float, float, float>;
Corner CornerOf(const ModelVertex& v) {
  return {v.x, v.y, v.z};
}

TEST(ModelReader, ReadsTheProjectsOwnModels) {
  std::vector<ModelEntry> entries;
  for (const char* name : kNames) entries.push_back({name, 20.0F});
  const ModelCatalogue models(kModels, entries);
  for (int number = 0; number < static_cast<int>(entries.size()); ++number) {
    const Result<std::unique_ptr<ModelPage>> read = ReadModel(models, number);
    ASSERT_TRUE(read.ok()) << read.message();
    const ModelPage& page = **read;
    float nose = -1e9F;
    float tail = 1e9F;
    for (const ModelVertex& v : page.vertices) {
      nose = std::max(nose, v.x);
      tail = std::min(tail, v.x);
      EXPECT_NEAR(std::hypot(v.normal_x, v.normal_y, v.normal_z), 1, 1e-3);
      EXPECT_LE(std::hypot(v.x, v.y, v.z), page.radius_m * 1.0001F);
    }
    EXPECT_NEAR(nose - tail, 20, 1e-3);
    EXPECT_GE(page.details.front().index_count, 3u * 150);
    EXPECT_LE(page.details.front().index_count, 3u * 700);
  }
}

// Every edge of a closed part is shared by as many triangles one way as the other.
TEST(ModelReader, ProjectsModelsAreClosedAndFaceOutwards) {
  for (const char* name : kNames) {
    const Result<std::unique_ptr<ModelPage>> read = ReadModelFile(kModels + "/" + name + ".gltf", 10);
    ASSERT_TRUE(read.ok()) << read.message();
    const ModelPage& page = **read;
    std::map<std::pair<Corner, Corner>, int> balance;
    int wrong_way = 0;
    double volume = 0;
    for (uint32_t i = 0; i < page.details[0].index_count; i += 3) {
      const ModelVertex& a = page.vertices[page.indices[i]];
      const ModelVertex& b = page.vertices[page.indices[i + 1]];
      const ModelVertex& c = page.vertices[page.indices[i + 2]];
      for (const auto& [from, to] : {std::pair{&a, &b}, {&b, &c}, {&c, &a}}) {
        ++balance[{CornerOf(*from), CornerOf(*to)}];
        --balance[{CornerOf(*to), CornerOf(*from)}];
      }
      const float nx = (b.y - a.y) * (c.z - a.z) - (b.z - a.z) * (c.y - a.y);
      const float ny = (b.z - a.z) * (c.x - a.x) - (b.x - a.x) * (c.z - a.z);
      const float nz = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
      wrong_way += nx * a.normal_x + ny * a.normal_y + nz * a.normal_z < 0 ? 1 : 0;
      volume += static_cast<double>(a.x * nx + a.y * ny + a.z * nz);
    }
    int open_edges = 0;
    for (const auto& [edge, count] : balance) open_edges += count != 0 ? 1 : 0;
    EXPECT_EQ(open_edges, 0) << name;
    EXPECT_EQ(wrong_way, 0) << name;
    EXPECT_GT(volume, 0) << name;
  }
}

TEST(ModelReader, DetailsGetCoarserAndKnowIt) {
  const Result<std::unique_ptr<ModelPage>> read = ReadModelFile(kModels + "/airliner.gltf", 38);
  ASSERT_TRUE(read.ok()) << read.message();
  const ModelPage& page = **read;
  ASSERT_GE(page.details.size(), 2u);
  EXPECT_EQ(page.details[0].error_m, 0);
  for (size_t i = 1; i < page.details.size(); ++i) {
    EXPECT_LT(page.details[i].index_count, page.details[i - 1].index_count);
    EXPECT_GE(page.details[i].error_m, page.details[i - 1].error_m);
    EXPECT_GT(page.details[i].error_m, 0);
    EXPECT_LT(page.details[i].error_m, 19);
    EXPECT_EQ(page.details[i].first_index, page.details[i - 1].first_index + page.details[i - 1].index_count);
  }
  EXPECT_EQ(page.details.back().first_index + page.details.back().index_count, page.indices.size());
  for (const uint32_t index : page.indices) ASSERT_LT(index, page.vertices.size());
}

// y up, z forward, x left in the file: forward becomes +x, left -y, up -z.
TEST(ModelReader, TurnsAxesAndTakesColours) {
  const std::string folder = testing::TempDir();
  TemporaryFile("wedge.mtl", "newmtl paint\nKd 1 0.5 0\n");
  const std::string path = TemporaryFile("wedge.obj",
                                         "mtllib belvedere_wedge.mtl\nusemtl paint\n"
                                         "v 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 4\n"
                                         "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  const Result<std::unique_ptr<ModelPage>> read = ReadModelFile(path, 8);
  ASSERT_TRUE(read.ok()) << read.message();
  std::set<Corner> corners;
  for (const ModelVertex& v : (*read)->vertices) {
    corners.insert({std::round(v.x), std::round(v.y), std::round(v.z)});
    EXPECT_EQ(v.colour, (std::array<uint8_t, 3>{255, 128, 0}));
  }
  EXPECT_EQ(corners, (std::set<Corner>{{0, 0, 0}, {0, -2, 0}, {0, 0, -4}, {8, 0, 0}}));
}

TEST(ModelReader, SaysWhatIsWrongWithAFile) {
  const ModelCatalogue models(kModels, {{"zeppelin", 200}});
  const Status missing = ReadModel(models, 0).status();
  EXPECT_NE(missing.message().find("zeppelin"), std::string::npos);
  EXPECT_FALSE(ReadModel(models, 1).ok());
  EXPECT_FALSE(ReadModel(models, -1).ok());
  const std::string broken = TemporaryFile("broken.gltf", "{\"asset\": {\"version\": ");
  EXPECT_NE(ReadModelFile(broken, 1).message().find(broken), std::string::npos);
  const std::string flat = TemporaryFile("flat.obj", "v 0 0 0\nv 1 0 0\nv 0 2 0\nf 1 3 2\n");
  EXPECT_NE(ReadModelFile(flat, 1).message().find("no length"), std::string::npos);
  const std::string points = TemporaryFile("points.obj", "v 0 0 0\nv 1 0 0\nv 0 2 0\np 1\np 2\n");
  EXPECT_FALSE(ReadModelFile(points, 1).ok());
}

TEST(ModelReader, WhatMovesByItselfKnowsItsJoint) {
  const auto read = ReadModelFile(std::string(BELVEDERE_SOURCE_DIR) + "/servers/models/tank.gltf", 9.75F);
  ASSERT_TRUE(read.ok()) << read.message();
  const ModelPage& tank = **read;
  std::array<size_t, kModelJoints> vertices{};
  float gun_forward_m = 0;
  for (const ModelVertex& v : tank.vertices) {
    ASSERT_LT(v.joint, kModelJoints);
    ++vertices[v.joint];
    if (v.joint == static_cast<uint8_t>(ModelJoint::kGun)) gun_forward_m = std::max(gun_forward_m, v.x);
  }
  for (const ModelJoint joint : {ModelJoint::kNone, ModelJoint::kTurret, ModelJoint::kGun, ModelJoint::kHatch}) {
    EXPECT_GT(vertices[static_cast<size_t>(joint)], 0u) << static_cast<int>(joint);
  }
  EXPECT_EQ(vertices[static_cast<size_t>(ModelJoint::kRotor)], 0u);
  EXPECT_NEAR(gun_forward_m, 5.8, 0.05);
  const glm::vec3 turret = tank.pivots[static_cast<size_t>(ModelJoint::kTurret)];
  EXPECT_NEAR(turret.x, -0.4, 0.02);
  EXPECT_NEAR(turret.z, -1.65, 0.02);
  EXPECT_NEAR(tank.pivots[static_cast<size_t>(ModelJoint::kGun)].x, 1.5, 0.02);  // under the turret in the file
}

}  // namespace
}  // namespace belvedere
