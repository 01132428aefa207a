#include "render/drawn_ground.h"

#include "runtime/earth/quadcode.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace belvedere {
namespace {

constexpr double kSlack = 1e-9;  // of a triangle's share: places on an edge belong to both sides

struct GridVertex {
  double east = 0, north = 0;  // grid units from the quadnode's south-west corner
  const ListVertex* vertex = nullptr;
};

// Vertices of one quadnode's triangles: almost all its own, some at its borders a neighbour's.
class Vertices {
 public:
  Vertices(const DisplayList& list, const TerrainDraw& drawn, double since_list_s)
      : list_(list), corner_(drawn.node.SouthWest()), since_list_s_(since_list_s) {}

  // east_at_pole: a pole is a point of every meridian.
  GridVertex At(uint32_t number, double east_at_pole) const {
    const ListVertex& vertex = (*list_.vertices)[number];
    const Quadcode node = list_.terrain_draws[vertex.draw()].node;
    const uint32_t x = node.SouthWest().x + vertex.post() % kPosts * node.PostSpacingEast();
    const uint32_t y = node.SouthWest().y + vertex.post() / kPosts * node.PostSpacingNorth();
    const bool pole = y == 0 || y == kGridNorthPole;
    return {pole ? east_at_pole : static_cast<double>(x - corner_.x),  // wraps at 180 E
            static_cast<double>(y - corner_.y), &vertex};
  }

  double HeightOf(const GridVertex& grid_vertex) const {
    const ListVertex& v = *grid_vertex.vertex;
    const TerrainDraw& draw = list_.terrain_draws[v.draw()];
    const double left = draw.rise_s > 0 ? std::clamp(1.0 - since_list_s_ / draw.rise_s, 0.0, 1.0) : 0.0;
    return ToGeodetic(list_.frames[draw.frame].ToEcef({v.x, v.y, v.z})).height_m + left * v.rise_m;
  }

 private:
  const DisplayList& list_;
  const GridPoint corner_;
  const double since_list_s_;
};

// Shares of the three corners at a place of the grid; nullopt outside of the triangle.
std::optional<std::array<double, 3>> SharesAt(const std::array<GridVertex, 3>& corners, double east, double north) {
  const auto area = [](double ax, double ay, double bx, double by) { return ax * by - ay * bx; };
  const auto& [a, b, c] = corners;
  const double whole = area(b.east - a.east, b.north - a.north, c.east - a.east, c.north - a.north);
  if (whole <= 0) return std::nullopt;
  const double of_b = area(east - a.east, north - a.north, c.east - a.east, c.north - a.north) / whole;
  const double of_c = area(b.east - a.east, b.north - a.north, east - a.east, north - a.north) / whole;
  const double of_a = 1.0 - of_b - of_c;
  if (std::min({of_a, of_b, of_c}) < -kSlack) return std::nullopt;
  return std::array<double, 3>{of_a, of_b, of_c};
}

}  // namespace

std::optional<double> DrawnGroundAt(const DisplayList& list, const Geodetic& place, double since_list_s) {
  const Quadcode finest = Quadcode::Containing(place.latitude_deg, place.longitude_deg, kMaxLevel);
  const auto draw = std::find_if(list.terrain_draws.begin(), list.terrain_draws.end(),
                                 [&](const TerrainDraw& d) { return d.node.Contains(finest); });
  if (draw == list.terrain_draws.end()) return std::nullopt;
  const Vertices vertices(list, *draw, since_list_s);
  const GeoBox box = draw->node.Box();
  const double per_degree = draw->node.GridHeight() / draw->node.HeightDegrees();
  const double east = std::clamp(std::remainder(place.longitude_deg - box.west_deg, 360.0) * per_degree, 0.0,
                                 static_cast<double>(draw->node.GridWidth()));
  const double north = (place.latitude_deg - box.south_deg) * per_degree;
  const auto indices = std::span(list.indices).subspan(draw->first_index, draw->index_count);
  for (size_t i = 0; i + 2 < indices.size(); i += 3) {
    const std::array<GridVertex, 3> corners{vertices.At(indices[i], east), vertices.At(indices[i + 1], east),
                                            vertices.At(indices[i + 2], east)};
    const auto shares = SharesAt(corners, east, north);
    if (!shares) continue;
    double height_m = 0;
    for (size_t corner = 0; corner < 3; ++corner) height_m += (*shares)[corner] * vertices.HeightOf(corners[corner]);
    return height_m;
  }
  return std::nullopt;
}

}  // namespace belvedere
