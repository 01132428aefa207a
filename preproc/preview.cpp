#include "preproc/preview.h"

#include "preproc/export_grid.h"
#include "preproc/layer_pixels.h"
#include "runtime/earth/ellipsoid.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <vector>

namespace belvedere {
namespace {

struct Stop {
  double at = 0;
  Rgb colour;
};

Rgb Between(std::span<const Stop> stops, double at) {
  const auto after = std::find_if(stops.begin(), stops.end(), [&](const Stop& stop) { return stop.at > at; });
  if (after == stops.begin()) return stops.front().colour;
  if (after == stops.end()) return stops.back().colour;
  const Stop& before = *(after - 1);
  const double share = (at - before.at) / (after->at - before.at);
  Rgb out{};
  for (size_t c = 0; c < 3; ++c)
    out[c] = static_cast<uint8_t>(std::lrint(before.colour[c] * (1 - share) + after->colour[c] * share));
  return out;
}

// The level whose posts or texels are as many across the box as there are pixels, or a few more.
Result<ExportGrid> GridFor(const Dataset& dataset, int layer, const GeoBox& box, int side) {
  const auto finest = PlanExport(dataset, layer, box, std::nullopt);
  if (!finest.ok()) return finest;
  int level = finest->level;
  const double across_deg = std::max(box.east_deg - box.west_deg, box.north_deg - box.south_deg);
  ExportGrid coarser = *finest;
  while (level > 0) {
    coarser.level = level - 1;
    if (across_deg / coarser.SpacingDegrees() < side) break;
    --level;
  }
  return PlanExport(dataset, layer, box, level);
}

// The means of squares of `step` pixels, rows from the north.
struct Shrunk {
  int width = 0, height = 0;
  std::vector<std::array<float, 4>> pixels;  // the channels that there are

  size_t OffsetOf(int column, int row) const {
    return static_cast<size_t>(row) * static_cast<size_t>(width) + static_cast<size_t>(column);
  }
};

template <typename Channels>
Shrunk Shrink(const ExportGrid& grid, int step, const Channels& channels) {
  Shrunk out{(grid.width + step - 1) / step, (grid.height + step - 1) / step, {}};
  out.pixels.resize(static_cast<size_t>(out.width) * static_cast<size_t>(out.height));
  std::vector<float> counts(out.pixels.size());
  for (int row = 0; row < grid.height; ++row) {
    for (int column = 0; column < grid.width; ++column) {
      const size_t to = out.OffsetOf(column / step, (grid.height - 1 - row) / step);
      const std::array<float, 4> from =
          channels(static_cast<size_t>(row) * static_cast<size_t>(grid.width) + static_cast<size_t>(column));
      for (size_t c = 0; c < 4; ++c) out.pixels[to][c] += from[c];
      counts[to] += 1;
    }
  }
  for (size_t i = 0; i < out.pixels.size(); ++i) {
    for (float& channel : out.pixels[i]) channel /= counts[i];
  }
  return out;
}

Result<Picture> PictureOfColours(LayerPixels& pixels, const ExportGrid& grid, int step) {
  constexpr float kGround = 235;  // seen through what is transparent
  std::vector<uint8_t> rgba(4 * static_cast<size_t>(grid.width) * static_cast<size_t>(grid.height));
  if (Status status = pixels.ReadColours({grid.first_column, grid.first_row, grid.width, grid.height}, rgba);
      !status.ok()) {
    return status;
  }
  const Shrunk shrunk = Shrink(grid, step, [&](size_t i) {
    const float alpha = static_cast<float>(rgba[4 * i + 3]) / 255;
    const auto over = [&](size_t c) { return alpha * rgba[4 * i + c] + (1 - alpha) * kGround; };
    return std::array<float, 4>{over(0), over(1), over(2), 0};
  });
  Picture picture(shrunk.width, shrunk.height);
  for (size_t i = 0; i < shrunk.pixels.size(); ++i) {
    for (size_t c = 0; c < 3; ++c) picture.rgb[3 * i + c] = static_cast<uint8_t>(std::lrint(shrunk.pixels[i][c]));
  }
  return picture;
}

// Rise to the north-west over each pixel, of pixels as long as wide.
std::vector<double> Slants(const Shrunk& heights, const ExportGrid& grid, int step) {
  std::vector<double> slants(heights.pixels.size());
  const double pixel_m = grid.SpacingDegrees() * step * kRadiansPerDegree * kEquatorialRadius_m;
  const auto at = [&](int column, int row) {
    return heights
        .pixels[heights.OffsetOf(std::clamp(column, 0, heights.width - 1), std::clamp(row, 0, heights.height - 1))][0];
  };
  for (int row = 0; row < heights.height; ++row) {
    for (int column = 0; column < heights.width; ++column) {
      const float rise = at(column + 1, row) - at(column - 1, row) + at(column, row + 1) - at(column, row - 1);
      slants[heights.OffsetOf(column, row)] = static_cast<double>(rise) / (2 * pixel_m);
    }
  }
  return slants;
}

Result<Picture> PictureOfHeights(LayerPixels& pixels, const ExportGrid& grid, int step, const Geoid& geoid) {
  static constexpr std::array<Stop, 9> kTints{{{-8000, {10, 30, 80}},
                                               {-3000, {40, 85, 145}},
                                               {-200, {120, 175, 210}},
                                               {-1, {175, 210, 225}},
                                               {0, {110, 150, 95}},
                                               {500, {170, 180, 115}},
                                               {1500, {190, 155, 105}},
                                               {3000, {150, 115, 95}},
                                               {5000, {245, 245, 245}}}};
  std::vector<float> heights_m(static_cast<size_t>(grid.width) * static_cast<size_t>(grid.height));
  if (Status status = pixels.ReadHeights({grid.first_column, grid.first_row, grid.width, grid.height}, heights_m);
      !status.ok()) {
    return status;
  }
  const Shrunk heights = Shrink(grid, step, [&](size_t i) { return std::array<float, 4>{heights_m[i], 0, 0, 0}; });
  const std::vector<double> slants = Slants(heights, grid, step);
  const double squares = std::inner_product(slants.begin(), slants.end(), slants.begin(), 0.0);
  const double usual = std::max(std::sqrt(squares / static_cast<double>(slants.size())), 1e-9);
  const GeoBox box = grid.Box();
  Picture picture(heights.width, heights.height);
  for (int row = 0; row < heights.height; ++row) {
    const double latitude_deg = std::max(box.north_deg - (row + 0.5) * step * grid.SpacingDegrees(), -90.0);
    for (int column = 0; column < heights.width; ++column) {
      const double longitude_deg = box.west_deg + (column + 0.5) * step * grid.SpacingDegrees();
      const size_t i = heights.OffsetOf(column, row);
      const double sea_m = geoid.Height(latitude_deg, std::remainder(longitude_deg, 360.0));
      Rgb colour = Between(kTints, static_cast<double>(heights.pixels[i][0]) - sea_m);
      const double light = 1 + 0.35 * std::tanh(slants[i] / usual);
      for (uint8_t& channel : colour) channel = static_cast<uint8_t>(std::clamp(channel * light, 0.0, 255.0));
      picture.Set(column, row, colour);
    }
  }
  return picture;
}

}  // namespace

Result<Preview> PreviewOf(const Dataset& dataset, int layer, const GeoBox& box, int side, const Geoid& geoid) {
  const auto grid = GridFor(dataset, layer, box, side);
  if (!grid.ok()) return grid.status();
  LayerPixels pixels(dataset, layer, grid->level, Enlarge::kCoarser);
  const int step = (std::max(grid->width, grid->height) + side - 1) / side;
  auto picture = grid->kind == LayerKind::kElevation ? PictureOfHeights(pixels, *grid, step, geoid)
                                                     : PictureOfColours(pixels, *grid, step);
  if (!picture.ok()) return picture.status();
  return Preview{grid->Box(), grid->level, std::move(*picture)};
}

Result<GeoBox> FinestBox(const Dataset& dataset, int layer) {
  const auto grid = PlanExport(dataset, layer, std::nullopt, std::nullopt);
  if (!grid.ok()) return grid.status();
  return grid->Box();
}

Picture MapOfLevels(const Dataset& dataset, std::span<const int> layers, int width) {
  std::vector<Quadcode> nodes;
  for (const int layer : layers) {
    for (const uint64_t word : dataset.Nodes(layer)) nodes.push_back(*Quadcode::FromWord(word));
  }
  // The finest last, over what it refines.
  std::stable_sort(nodes.begin(), nodes.end(), [](Quadcode a, Quadcode b) { return a.level() < b.level(); });
  const int finest = nodes.empty() ? 0 : nodes.back().level();
  Picture map(width, width / 2);
  const double pixels_per_degree = width / 360.0;
  for (const Quadcode node : nodes) {
    const GeoBox box = node.Box();
    const Rgb colour = LevelColour(node.level(), finest);
    // All pixels that it touches, so that what is smaller than one is seen.
    constexpr double kSlack = 1e-9;
    const auto left = static_cast<int>((box.west_deg + 180) * pixels_per_degree + kSlack);
    const auto top = static_cast<int>((90 - box.north_deg) * pixels_per_degree + kSlack);
    const auto right = static_cast<int>(std::ceil((box.east_deg + 180) * pixels_per_degree - kSlack));
    const auto bottom = static_cast<int>(std::ceil((90 - box.south_deg) * pixels_per_degree - kSlack));
    for (int row = top; row < std::min(bottom, map.height); ++row) {
      for (int column = left; column < std::min(right, map.width); ++column) map.Set(column, row, colour);
    }
  }
  return map;
}

Rgb LevelColour(int level, int finest_level) {
  // Five of the colours of viridis (van der Walt and Smith 2015): of even steps in brightness, also to the
  // colour-blind.
  static constexpr std::array<Stop, 5> kScale{
      {{0, {68, 1, 84}}, {0.25, {59, 82, 139}}, {0.5, {33, 145, 140}}, {0.75, {94, 201, 98}}, {1, {253, 231, 37}}}};
  return Between(kScale, finest_level == 0 ? 0.0 : static_cast<double>(level) / finest_level);
}

}  // namespace belvedere
