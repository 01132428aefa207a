#include "runtime/paging/terrain_height.h"

#include "runtime/earth/ellipsoid.h"
#include "runtime/earth/frame.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace belvedere {
namespace {

glm::dvec3 VertexInFrame(const TerrainPage& page, int column, int row) {
  return PlaceOf(page.vertices[static_cast<size_t>(row * kPosts + column)]);
}

}  // namespace

GroundPoint GroundOnPage(const TerrainPage& page, double latitude_deg, double longitude_deg) {
  const GeoBox box = page.node.Box();
  const double width = page.node.WidthDegrees();
  const double east_of_box = std::remainder(longitude_deg - (box.west_deg + 0.5 * width), 360.0) + 0.5 * width;
  const double x = std::clamp(east_of_box / width, 0.0, 1.0) * kCells;
  const double y = std::clamp((latitude_deg - box.south_deg) / page.node.HeightDegrees(), 0.0, 1.0) * kCells;
  const int column = std::min(static_cast<int>(x), kCells - 1);
  const int row = std::min(static_cast<int>(y), kCells - 1);
  const double u = x - column;
  const double v = y - row;

  const glm::dvec3 south_west = VertexInFrame(page, column, row);
  const glm::dvec3 south_east = VertexInFrame(page, column + 1, row);
  const glm::dvec3 north_west = VertexInFrame(page, column, row + 1);
  const glm::dvec3 north_east = VertexInFrame(page, column + 1, row + 1);
  const glm::dvec3 east = glm::mix(south_east - south_west, north_east - north_west, v);
  const glm::dvec3 north = glm::mix(north_west - south_west, north_east - south_east, u);
  const glm::dvec3 local = south_west + u * (south_east - south_west) + v * north;

  const Frame frame = FrameOf(page.node);
  const glm::dvec3 normal = glm::cross(east, north);
  GroundPoint ground;
  ground.height_m = ToGeodetic(frame.ToEcef(local)).height_m;
  ground.normal_ecef =
      glm::dot(normal, normal) > 0 ? frame.ecef_from_frame * glm::normalize(normal) : UpAt(latitude_deg, longitude_deg);
  ground.level = page.node.level();
  return ground;
}

std::optional<GroundPoint> GroundUnder(Paging& paging, DataType terrain, double latitude_deg, double longitude_deg) {
  int level = paging.layers.at(terrain).max_level;
  for (Quadcode node = Quadcode::Containing(latitude_deg, longitude_deg, level);; node = node.Parent()) {
    const PageKey key{terrain, node};
    if (paging.cache.Contains(key)) {
      if (const PagePin pin = paging.cache.Find(key))
        return GroundOnPage(pin.as<TerrainPage>(), latitude_deg, longitude_deg);
    }
    if (node.is_root()) return std::nullopt;
  }
}

}  // namespace belvedere
