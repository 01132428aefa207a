// Terrain pages and cuts made of random numbers, for tests that must hold for any terrain whatever.
#pragma once

#include "managers/cut.h"
#include "runtime/earth/bisection.h"
#include "runtime/earth/ellipsoid.h"
#include "runtime/earth/frame.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <memory>
#include <random>
#include <unordered_map>
#include <vector>

namespace belvedere::test {

// Delta values of one page: log-uniform noise, large at the coarse levels, so that a search from the roots gets through
// to where some triangles are split and others are not.
inline std::vector<float> RandomDeltas(std::mt19937& random) {
  constexpr int kSurelySplit = 8;
  std::vector<float> deltas(kVerticesPerPage);
  std::uniform_real_distribution<float> any(-6.0F, 12.0F);
  std::uniform_real_distribution<float> large(9.0F, 12.0F);
  for (int index = 0; index < kVerticesPerPage; ++index) {
    const int level = LevelOf(Post{index % kPosts, index / kPosts});
    deltas[static_cast<size_t>(index)] = std::exp2(level < kSurelySplit ? large(random) : any(random));
  }
  return deltas;
}

// Leaves in spread_m[level] the greatest distance from a post of that level to a corner of a triangle that it splits.
inline void MeasureSpread(TerrainPage& page, int a, int b, int c, int level) {
  if (level == kBisections) return;
  const int middle = (b + c) / 2;
  const auto at = [&](int post) {
    const TerrainVertex& v = page.vertices[static_cast<size_t>(post)];
    return glm::vec3(v.x, v.y, v.z);
  };
  float& spread = page.spread_m[static_cast<size_t>(level)];
  for (const int corner : {a, b, c}) spread = std::max(spread, 1.001F * glm::distance(at(middle), at(corner)));
  MeasureSpread(page, middle, a, b, level + 1);
  MeasureSpread(page, middle, c, a, level + 1);
}

// A page of flat ground with random delta values.
inline std::unique_ptr<TerrainPage> FlatPage(Quadcode node, std::vector<float> deltas) {
  auto page = std::make_unique<TerrainPage>();
  page->node = node;
  page->deltas = std::move(deltas);
  page->vertices.resize(kVerticesPerPage);
  const Frame frame = FrameOf(node);
  const GeoBox box = node.Box();
  const double east = node.WidthDegrees() / kCells, north = node.HeightDegrees() / kCells;
  page->center_ecef = ToEcef({0.5 * (box.south_deg + box.north_deg), 0.5 * (box.west_deg + box.east_deg), 0.0});
  for (int row = 0; row < kPosts; ++row) {
    for (int column = 0; column < kPosts; ++column) {
      const glm::dvec3 ecef = ToEcef({box.south_deg + row * north, box.west_deg + column * east, 0.0});
      const glm::vec3 local(frame.ToFrame(ecef));
      page->vertices[static_cast<size_t>(row * kPosts + column)] = {local.x, local.y, local.z, 0};
      page->radius_m = std::max(page->radius_m, glm::distance(ecef, page->center_ecef));
    }
  }
  MeasureSpread(*page, kCells, kCells * kPosts + kCells, 0, 0);
  MeasureSpread(*page, kCells * kPosts, 0, kCells * kPosts + kCells, 0);
  return page;
}

// Screen-space error of the post's delta value, were it a shift of the post `where` along the vertical there, found by
// shifting it; 0 where that is not in a round picture of that corner.
inline double SeenError_px(const TerrainPage& page, int post, int where, const Sight& sight, double pixels_per_radian) {
  constexpr double kShift_m = 0.1;
  const TerrainVertex& v = page.vertices[static_cast<size_t>(where)];
  const glm::dvec3 ecef = FrameOf(page.node).ToEcef({v.x, v.y, v.z});
  const Geodetic place = ToGeodetic(ecef);
  const auto seen_at = [&](const glm::dvec3& point) {
    const glm::dvec3 away = point - sight.eye_ecef;
    return away / glm::dot(away, sight.forward_ecef);
  };
  const glm::dvec3 away = ecef - sight.eye_ecef;
  if (glm::dot(away, sight.forward_ecef) < sight.cos_corner * glm::length(away)) return 0;
  const glm::dvec3 shifted = ecef + kShift_m * UpAt(place.latitude_deg, place.longitude_deg);
  return page.deltas[static_cast<size_t>(post)] * pixels_per_radian * glm::distance(seen_at(shifted), seen_at(ecef)) /
         kShift_m;
}

// The largest of the triangle's corners and the middle of its hypotenuse, of the post that would split it; 0 for what
// is as small as triangles get.
inline double SeenErrorOfTriangle_px(const TerrainPage& page, const std::array<int, 3>& posts, const Sight& sight,
                                     double pixels_per_radian) {
  const auto [a, b, c] = posts;
  if ((b % kPosts + c % kPosts) % 2 != 0 || (b / kPosts + c / kPosts) % 2 != 0) return 0;
  const int middle = (b + c) / 2;
  double largest = 0;
  for (const int where : {a, b, c, middle})
    largest = std::max(largest, SeenError_px(page, middle, where, sight, pixels_per_radian));
  return largest;
}

// A random cut of the whole Earth: roots split again and again at random, down to `deepest`.
inline std::vector<Quadcode> RandomCutNodes(std::mt19937& random, int splits, int deepest) {
  std::vector<Quadcode> nodes;
  for (int tree = 0; tree < kTrees; ++tree) nodes.push_back(Quadcode::Root(tree));
  for (int i = 0; i < splits; ++i) {
    // Mostly split what was split last, so that great steps of level stand side by side.
    std::uniform_int_distribution<size_t> any(0, nodes.size() - 1);
    std::uniform_int_distribution<size_t> recent(nodes.size() - std::min<size_t>(nodes.size(), 4), nodes.size() - 1);
    const size_t chosen = i % 3 == 0 ? any(random) : recent(random);
    const Quadcode node = nodes[chosen];
    if (node.level() >= deepest) continue;
    nodes.erase(nodes.begin() + static_cast<std::ptrdiff_t>(chosen));
    for (const int which : node.Children()) nodes.push_back(node.Child(which));
  }
  return nodes;
}

}  // namespace belvedere::test
