#include "preproc/feather.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace belvedere {
namespace {

constexpr int32_t kNone = std::numeric_limits<int32_t>::max();

}  // namespace

Feather::Feather(DomainWindow window) : window_(std::move(window)) {
  whole_ = std::all_of(window_.inside.begin(), window_.inside.end(), [](uint8_t inside) { return inside != 0; });
  if (whole_) return;
  left_.resize(window_.inside.size());
  right_.resize(window_.inside.size());
  const auto width = static_cast<size_t>(window_.width);
  const auto next = [](bool inside, int32_t before) { return !inside ? 0 : before == kNone ? kNone : before + 1; };
  for (size_t row = 0; row < static_cast<size_t>(window_.height); ++row) {
    const size_t first = row * width;
    int32_t distance = kNone;
    for (size_t i = first; i < first + width; ++i) left_[i] = distance = next(window_.inside[i] != 0, distance);
    distance = kNone;
    for (size_t i = first + width; i-- > first;) right_[i] = distance = next(window_.inside[i] != 0, distance);
  }
}

// In pixels, from x in that column to the nearest pixel of the row that is not inside.
double Feather::DistanceInRow(int row, int column, double x) const {
  const size_t at = static_cast<size_t>(row) * static_cast<size_t>(window_.width) + static_cast<size_t>(column);
  if (window_.inside[at] == 0) return 0;
  double distance = std::numeric_limits<double>::infinity();
  if (left_[at] != kNone) distance = x - (column - left_[at] + 1);
  if (right_[at] != kNone) distance = std::min(distance, column + right_[at] - x);
  return distance;
}

double Feather::DistanceAt(double x, double y, const PixelSize& size, double most_m) const {
  if (whole_) return most_m;
  const double from_x = x - window_.x, from_y = y - window_.y;
  const int column = std::clamp(static_cast<int>(std::floor(from_x)), 0, window_.width - 1);
  const int middle = std::clamp(static_cast<int>(std::floor(from_y)), 0, window_.height - 1);
  double least = most_m * most_m;
  const auto look_at = [&](int row, double rows_away) {
    const double north_m = rows_away * size.y_m;
    if (north_m * north_m >= least) return false;
    const double east_m = DistanceInRow(row, column, from_x) * size.x_m;
    least = std::min(least, east_m * east_m + north_m * north_m);
    return true;
  };
  look_at(middle, 0);
  for (int row = middle - 1; row >= 0 && look_at(row, from_y - row - 1); --row) continue;
  for (int row = middle + 1; row < window_.height && look_at(row, row - from_y); ++row) continue;
  return std::sqrt(least);
}

float Feather::WeightAt(double x, double y, const PixelSize& size, double feather_m) const {
  if (whole_) return 1.0f;
  const double t = DistanceAt(x, y, size, feather_m) / feather_m;
  return t >= 1 ? 1.0f : static_cast<float>(t * t * (3 - 2 * t));
}

}  // namespace belvedere
