#include "servers/texel_heights.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace belvedere {
namespace {

constexpr size_t kSide = kElevationSide;
constexpr size_t kCellSide = kElevationSide - 1;

// Between which two posts, or cells, a texel lies along either axis, and how far towards the second.
struct Between {
  size_t first = 0;
  float share = 0;
};
using Places = std::array<Between, kImageSide>;

// origin: where the first of `count` lies, in posts from the page's own first.
Places PlacesAmong(size_t count, double origin) {
  Places places;
  for (size_t i = 0; i < places.size(); ++i) {
    const double post = (static_cast<double>(i) - kImageGutter + 0.5) * kPostsPerTexel;
    const double at = std::clamp(post - origin, 0.0, static_cast<double>(count - 1));
    const size_t first = std::min(static_cast<size_t>(at), count - 2);
    places[i] = {first, static_cast<float>(at - static_cast<double>(first))};
  }
  return places;
}

// The page's posts above mean sea level.
std::vector<float> PostsAboveSea(const ElevationPage& page, Quadcode node, const Geoid* sea) {
  std::vector<float> posts_m(kSide * kSide);
  std::vector<double> sea_m(posts_m.size());
  if (sea != nullptr) {
    const GeoBox box = node.Box();
    std::array<double, kSide> latitudes_deg{};
    std::array<double, kSide> longitudes_deg{};
    for (size_t i = 0; i < kSide; ++i) {
      const double posts = static_cast<double>(i) - kApron;
      latitudes_deg[i] = std::clamp(box.south_deg + posts * node.HeightDegrees() / kCells, -90.0, 90.0);
      longitudes_deg[i] = box.west_deg + posts * node.WidthDegrees() / kCells;
    }
    sea_m = sea->Heights(latitudes_deg, longitudes_deg);
  }
  for (size_t i = 0; i < posts_m.size(); ++i) {
    posts_m[i] = static_cast<float>(1e-3 * page.heights_mm[i] - sea_m[i]);
  }
  return posts_m;
}

struct Cell {
  float mean_m = 0, rise_east_m = 0, rise_north_m = 0;
};

std::vector<Cell> CellsOf(const std::vector<float>& posts_m) {
  std::vector<Cell> cells;
  cells.reserve(kCellSide * kCellSide);
  for (size_t row = 0; row < kCellSide; ++row) {
    const float* south = &posts_m[row * kSide];
    const float* north = south + kSide;
    for (size_t i = 0; i < kCellSide; ++i) {
      cells.push_back({0.25F * (south[i] + south[i + 1] + north[i] + north[i + 1]),
                       0.5F * (south[i + 1] - south[i] + north[i + 1] - north[i]),
                       0.5F * (north[i] - south[i] + north[i + 1] - south[i + 1])});
    }
  }
  return cells;
}

float Mix(float a, float b, float share) {
  return a + share * (b - a);
}

Cell Mix(const Cell& a, const Cell& b, float share) {
  return {Mix(a.mean_m, b.mean_m, share), Mix(a.rise_east_m, b.rise_east_m, share),
          Mix(a.rise_north_m, b.rise_north_m, share)};
}

}  // namespace

std::vector<TexelHeight> HeightsAtTexels(const ElevationPage& page, Quadcode node, const Geoid* sea) {
  static const Places kAmongPosts = PlacesAmong(kSide, -kApron);
  static const Places kAmongCells = PlacesAmong(kCellSide, 0.5 - kApron);
  const std::vector<float> posts_m = PostsAboveSea(page, node, sea);
  const std::vector<Cell> cells = CellsOf(posts_m);
  std::vector<TexelHeight> texels(static_cast<size_t>(kImageSide) * kImageSide);
  std::array<float, kSide> posts_of_row{};
  std::array<Cell, kCellSide> cells_of_row{};
  TexelHeight* texel = texels.data();
  for (size_t row = 0; row < kImageSide; ++row) {
    const Between& post_row = kAmongPosts[row];
    const float* south = &posts_m[post_row.first * kSide];
    for (size_t i = 0; i < kSide; ++i) posts_of_row[i] = Mix(south[i], south[i + kSide], post_row.share);
    const Between& cell_row = kAmongCells[row];
    const Cell* south_cell = &cells[cell_row.first * kCellSide];
    for (size_t i = 0; i < kCellSide; ++i) {
      cells_of_row[i] = Mix(south_cell[i], south_cell[i + kCellSide], cell_row.share);
    }
    for (size_t column = 0; column < kImageSide; ++column) {
      const Between& post = kAmongPosts[column];
      const Between& at = kAmongCells[column];
      const Cell cell = Mix(cells_of_row[at.first], cells_of_row[at.first + 1], at.share);
      *texel++ = {Mix(posts_of_row[post.first], posts_of_row[post.first + 1], post.share), cell.mean_m,
                  cell.rise_east_m, cell.rise_north_m};
    }
  }
  return texels;
}

}  // namespace belvedere
