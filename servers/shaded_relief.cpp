#include "servers/shaded_relief.h"

#include "runtime/base/status.h"
#include "runtime/earth/post_grid.h"
#include "runtime/earth/units.h"
#include "servers/mip_levels.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace belvedere {
namespace {

// Cells of the page and of its apron.
constexpr int kCellsAcross = kElevationSide - 1;

constexpr double kUnraisedSpacing_m = 400;
constexpr double kRaisePower = 0.7;
constexpr double kMostRaised = 24;
constexpr float kSeaShare = 0.25F;          // of a slope that counts under the sea
constexpr double kDeepBelowSea_m = -250;    // from here down only that share counts,
constexpr double kShallowBelowSea_m = -20;  // and from here up all of it: some land lies below the sea
constexpr double kMostGeoid_m = 110;        // mean sea level is never further from the ellipsoid than this

constexpr float kLightEast = -0.5F;
constexpr float kLightNorth = 0.5F;
constexpr float kLightUp = 0.70710678F;
constexpr float kFlat = 128;
constexpr float kContrast = 105;  // of brightness, 1 being that of flat ground

struct Slope {
  float east = 0, north = 0;
};

// How much slopes count at a height: 1 on land, kSeaShare in the deep sea.
float LandShare(double height_m, const Geoid* sea, double latitude_deg, double longitude_deg) {
  if (height_m > kShallowBelowSea_m + kMostGeoid_m) return 1;
  if (height_m < kDeepBelowSea_m - kMostGeoid_m) return kSeaShare;
  if (sea != nullptr) height_m -= sea->Height(std::clamp(latitude_deg, -90.0, 90.0), longitude_deg);
  const double share = (height_m - kDeepBelowSea_m) / (kShallowBelowSea_m - kDeepBelowSea_m);
  return kSeaShare + (1 - kSeaShare) * static_cast<float>(std::clamp(share, 0.0, 1.0));
}

class Cells {
 public:
  Cells(const ElevationPage& heights, Quadcode node, const Geoid* sea)
      : slopes_(static_cast<size_t>(kCellsAcross) * kCellsAcross) {
    const double step_deg = node.HeightDegrees() / kCells;
    const double step_east_deg = node.WidthDegrees() / kCells;
    const double step_radians = step_deg * kRadiansPerDegree;
    const double spacing_m = step_radians * RowAt(0).prime_vertical_m;
    const double raised = std::clamp(std::pow(spacing_m / kUnraisedSpacing_m, kRaisePower), 1.0, kMostRaised);
    const GeoBox box = node.Box();
    for (int row = 0; row < kCellsAcross; ++row) {
      const double latitude_deg = box.south_deg + (row - kApron + 0.5) * step_deg;
      const RowGeometry geometry = RowAt(latitude_deg);
      // Towards a pole posts crowd; their slopes along the parallel would be noise.
      const double cos_latitude = std::max(std::abs(geometry.cos_latitude), 0.02);
      const double run_east_m = step_east_deg * kRadiansPerDegree * geometry.prime_vertical_m * cos_latitude;
      const double run_north_m = step_radians * geometry.meridian_m;
      for (int column = 0; column < kCellsAcross; ++column) {
        const auto post = [&](int east, int north) {
          return 1e-3 * heights.at(column - kApron + east, row - kApron + north);
        };
        const double sw = post(0, 0), se = post(1, 0), nw = post(0, 1), ne = post(1, 1);
        const double longitude_deg = box.west_deg + (column - kApron + 0.5) * step_east_deg;
        const double share =
            raised * static_cast<double>(LandShare(0.25 * (sw + se + nw + ne), sea, latitude_deg, longitude_deg));
        slopes_[static_cast<size_t>(row * kCellsAcross + column)] = {
            static_cast<float>(share * 0.5 * (se - sw + ne - nw) / run_east_m),
            static_cast<float>(share * 0.5 * (nw - sw + ne - se) / run_north_m)};
      }
    }
  }

  const Slope* Row(int row) const { return slopes_.data() + row * kCellsAcross; }

 private:
  std::vector<Slope> slopes_;
};

// Between which two cells the middle of a texel lies, along either axis, and how far towards the second.
struct Between {
  int first = 0;
  float share = 0;
};

std::array<Between, kImageSide> TexelsAmongCells() {
  std::array<Between, kImageSide> texels;
  for (int i = 0; i < kImageSide; ++i) {
    const double post = (i - kImageGutter + 0.5) * kCells / kImageInner;
    const double cell = std::clamp(post + kApron - 0.5, 0.0, kCellsAcross - 1.0);
    const int first = std::min(static_cast<int>(cell), kCellsAcross - 2);
    texels[static_cast<size_t>(i)] = {first, static_cast<float>(cell - first)};
  }
  return texels;
}

uint8_t Shade(const Slope& slope) {
  const float length = std::sqrt(1.0F + slope.east * slope.east + slope.north * slope.north);
  const float light = (kLightUp - slope.east * kLightEast - slope.north * kLightNorth) / (length * kLightUp);
  return static_cast<uint8_t>(std::clamp(kFlat + kContrast * (std::max(light, 0.0F) - 1.0F) + 0.5F, 0.0F, 255.0F));
}

}  // namespace

std::unique_ptr<ImagePage> ShadeRelief(const ElevationPage& heights, Quadcode node, const Geoid* sea) {
  auto page = std::make_unique<ImagePage>();
  page->format = ImageFormat::kR8;
  page->texels.resize(ImagePage::MipOffset(kImageMipLevels, page->format));
  const Cells cells(heights, node, sea);
  static const std::array<Between, kImageSide> kTexels = TexelsAmongCells();
  std::array<Slope, kCellsAcross> blended;
  uint8_t* texel = page->texels.data();
  for (const Between& row : kTexels) {
    const Slope* south = cells.Row(row.first);
    const Slope* north = cells.Row(row.first + 1);
    for (size_t i = 0; i < kCellsAcross; ++i) {
      blended[i] = {south[i].east + row.share * (north[i].east - south[i].east),
                    south[i].north + row.share * (north[i].north - south[i].north)};
    }
    for (const Between& column : kTexels) {
      const Slope& west = blended[static_cast<size_t>(column.first)];
      const Slope& east = blended[static_cast<size_t>(column.first) + 1];
      *texel++ = Shade(
          {west.east + column.share * (east.east - west.east), west.north + column.share * (east.north - west.north)});
    }
  }
  FillMipLevels(*page);
  return page;
}

}  // namespace belvedere
