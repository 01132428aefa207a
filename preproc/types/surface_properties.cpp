#include "preproc/types/surface_properties.h"

#include "runtime/earth/post_grid.h"
#include "runtime/earth/units.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace belvedere {
namespace {

constexpr int kFirst = -kApron, kLast = kPosts - 1 + kApron;  // posts of a page
constexpr double kRounding_m = 0.1;                           // that heights are stored with

uint8_t Byte(double value) {
  return static_cast<uint8_t>(std::lrint(std::clamp(value, 0.0, 255.0)));
}

// The 3 x 3 posts around one, in metres, row by row from the south-west, and the distances between them.
struct Surroundings {
  std::array<double, 9> heights_m{};
  double east_m = 1, north_m = 1;
  double latitude_deg = 0, longitude_deg = 0;

  // Rise over run of the plane that fits best (least squares).
  double SlopeEast() const {
    const auto& h = heights_m;
    return (h[2] + h[5] + h[8] - h[0] - h[3] - h[6]) / (6 * east_m);
  }
  double SlopeNorth() const {
    const auto& h = heights_m;
    return (h[6] + h[7] + h[8] - h[0] - h[1] - h[2]) / (6 * north_m);
  }
};

void MeasureSpacing(Surroundings& around, Quadcode node) {
  const RowGeometry parallel = RowAt(around.latitude_deg);
  const double east = node.WidthDegrees() / kCells * kRadiansPerDegree;
  around.north_m = parallel.meridian_m * node.HeightDegrees() / kCells * kRadiansPerDegree;
  // At a pole posts fall together.
  around.east_m = std::max(parallel.prime_vertical_m * parallel.cos_latitude * east, 0.01 * around.north_m);
}

// value: from what is around a post to a byte for each channel.
template <size_t kChannels, typename Value>
std::shared_ptr<PropertyPage> Make(const ElevationPage& page, Quadcode node, Value value) {
  constexpr size_t kPlane = static_cast<size_t>(kElevationSide) * static_cast<size_t>(kElevationSide);
  auto made = std::make_shared<PropertyPage>();
  made->channels = static_cast<int>(kChannels);
  made->values.resize(kChannels * kPlane);
  const GeoBox box = node.Box();
  const double step_north_deg = node.HeightDegrees() / kCells;
  const double step_east_deg = node.WidthDegrees() / kCells;
  for (int row = kFirst; row <= kLast; ++row) {
    const int y = std::clamp(row, kFirst + 1, kLast - 1);
    Surroundings around;
    around.latitude_deg = std::clamp(box.south_deg + y * step_north_deg, -90.0, 90.0);
    MeasureSpacing(around, node);
    for (int column = kFirst; column <= kLast; ++column) {
      const int x = std::clamp(column, kFirst + 1, kLast - 1);
      around.longitude_deg = box.west_deg + x * step_east_deg;
      for (int i = 0; i < 9; ++i)
        around.heights_m[static_cast<size_t>(i)] = page.at(x - 1 + i % 3, y - 1 + i / 3) / 1000.0;
      const std::array<uint8_t, kChannels> bytes = value(around);
      const auto at = static_cast<size_t>((row - kFirst) * kElevationSide + column - kFirst);
      for (size_t channel = 0; channel < kChannels; ++channel) made->values[channel * kPlane + at] = bytes[channel];
    }
  }
  return made;
}

}  // namespace

std::shared_ptr<PropertyPage> SlopeAngles(const ElevationPage& page, Quadcode node) {
  return Make<1>(page, node, [](const Surroundings& around) {
    const double angle_deg = std::atan(std::hypot(around.SlopeEast(), around.SlopeNorth())) / kRadiansPerDegree;
    return std::array{Byte(kSlopeSteps_deg * angle_deg)};
  });
}

std::shared_ptr<PropertyPage> NormalMap(const ElevationPage& page, Quadcode node) {
  return Make<3>(page, node, [](const Surroundings& around) {
    const double east = -around.SlopeEast(), north = -around.SlopeNorth();
    const double length = std::sqrt(east * east + north * north + 1);
    const auto byte = [=](double part) { return Byte(127.5 * (part / length + 1)); };
    return std::array{byte(east), byte(north), byte(1)};
  });
}

std::shared_ptr<PropertyPage> Roughness(const ElevationPage& page, Quadcode node) {
  return Make<1>(page, node, [](const Surroundings& around) {
    double mean_m = 0, squares = 0;
    for (const double height_m : around.heights_m) mean_m += height_m / 9;
    for (int i = 0; i < 9; ++i) {
      const int column = i % 3 - 1, row = i / 3 - 1;
      const double plane_m =
          mean_m + around.SlopeEast() * around.east_m * column + around.SlopeNorth() * around.north_m * row;
      const double off_m = around.heights_m[static_cast<size_t>(i)] - plane_m;
      squares += off_m * off_m;
    }
    return std::array{Byte(kRoughnessSteps_m * std::sqrt(squares / 9))};
  });
}

std::shared_ptr<PropertyPage> WaterMask(const ElevationPage& page, Quadcode node, const Geoid& sea) {
  return Make<1>(page, node, [&sea](const Surroundings& around) {
    double mean_m = 0;
    for (const double height_m : around.heights_m) mean_m += height_m / 9;
    const double sea_m = sea.Height(around.latitude_deg, around.longitude_deg) + kRounding_m;
    return std::array{static_cast<uint8_t>(around.heights_m[4] <= sea_m && mean_m <= sea_m ? 1 : 0)};
  });
}

}  // namespace belvedere
