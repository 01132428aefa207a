#include "servers/graticule.h"

#include "servers/mip_levels.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace belvedere {
namespace {

constexpr TexelColour kLine = {245, 245, 245};
constexpr TexelColour kHalo = {20, 24, 40};
constexpr float kThin = 0.45F;  // half the width, in texels
constexpr float kHeavy = 0.9F;
constexpr float kLineCover = 0.75F;
constexpr int64_t kSecond = 100;
constexpr int64_t kMinute = 60 * kSecond;
constexpr int64_t kDegree = kGridUnitsPerDegree;
constexpr int kTextAbove = 9;  // texels from a line to the middle of its text
constexpr int kFromWest = 6;   // texels from the page's inner edge to the text of a latitude

// The lines of one direction, at multiples of the step. Texel t's middle lies at t + 0.5.
class Lines {
 public:
  Lines(double low_deg, double size_deg, int64_t step, bool is_latitude)
      : low_(low_deg * kDegree),
        per_unit_(kImageInner / (size_deg * kDegree)),
        step_(step),
        is_latitude_(is_latitude) {}

  double TexelOf(int64_t value) const { return kImageGutter + (static_cast<double>(value) - low_) * per_unit_; }
  int64_t NearestTo(double texel) const {
    const double value = low_ + (texel - kImageGutter) / per_unit_;
    return step_ * std::llround(value / static_cast<double>(step_));
  }
  bool IsPole(int64_t value) const { return is_latitude_ && std::abs(value) >= 90 * kDegree; }
  float Cover(int texel) const {
    const double middle = texel + 0.5;
    const int64_t value = NearestTo(middle);
    if (IsPole(value)) return 0;
    const float half = value % (180 * kDegree) == 0 ? kHeavy : kThin;
    const auto off = static_cast<float>(std::abs(TexelOf(value) - middle));
    return kLineCover * std::clamp(half + 0.5F - off, 0.0F, 1.0F);
  }
  std::array<float, kImageSide> Covers() const {
    std::array<float, kImageSide> covers{};
    for (int texel = 0; texel < kImageSide; ++texel) covers[static_cast<size_t>(texel)] = Cover(texel);
    return covers;
  }
  // The line nearest to the page's middle, if it passes within the inner texels.
  std::optional<int64_t> Named() const {
    const int64_t value = NearestTo(0.5 * kImageSide);
    const double texel = TexelOf(value);
    if (IsPole(value) || texel < kImageGutter || texel >= kImageGutter + kImageInner) return std::nullopt;
    return value;
  }
  std::string NameOf(int64_t value) const { return CoordinateName(value, step_, is_latitude_); }

 private:
  double low_, per_unit_;
  int64_t step_;
  bool is_latitude_;
};

TexelBox MovedInside(TexelBox box) {
  const int east = std::max(kInnerTexels.west - box.west, 0) - std::max(box.east - kInnerTexels.east, 0);
  const int north = std::max(kInnerTexels.south - box.south, 0) - std::max(box.north - kInnerTexels.north, 0);
  return {box.west + east, box.south + north, box.east + east, box.north + north};
}

void WriteNames(ImagePage& page, const Lines& latitudes, const Lines& longitudes, const PageText& text) {
  TexelBox taken;
  if (const std::optional<int64_t> value = latitudes.Named()) {
    const int row = static_cast<int>(latitudes.TexelOf(*value)) + kTextAbove;
    const std::string name = latitudes.NameOf(*value);
    const TexelBox centred = text.BoxAround(name, 0, row);
    taken = MovedInside(text.BoxAround(name, kImageGutter + kFromWest - centred.west, row));
    text.Write(page, taken, name, kLine, kHalo);
  }
  if (const std::optional<int64_t> value = longitudes.Named()) {
    const int column = static_cast<int>(longitudes.TexelOf(*value));
    const std::string name = longitudes.NameOf(*value);
    TexelBox box = MovedInside(text.BoxAround(name, column, kImageSide / 4));
    if (box.Meets(taken)) box = MovedInside(text.BoxAround(name, column, 3 * kImageSide / 4));
    text.Write(page, box, name, kLine, kHalo);
  }
}

}  // namespace

int64_t GridStep(int level) {
  constexpr std::array<int64_t, 5> kDegrees = {15, 10, 5, 2, 1};
  constexpr std::array<int64_t, 6> kSixtieths = {30, 20, 10, 5, 2, 1};
  constexpr std::array<int64_t, 6> kHundredths = {50, 20, 10, 5, 2, 1};
  const double least = kTreeDegrees / static_cast<double>(int64_t{1} << level) / 4 * kDegree;
  int64_t step = 30 * kDegree;
  const auto take = [&](auto numbers, int64_t unit) {
    for (const int64_t number : numbers) {
      if (static_cast<double>(number * unit) >= least) step = number * unit;
    }
  };
  take(kDegrees, kDegree);
  take(kSixtieths, kMinute);
  take(kSixtieths, kSecond);
  take(kHundredths, 1);
  return step;
}

std::string CoordinateName(int64_t value, int64_t step, bool is_latitude) {
  if (!is_latitude) {
    value = ((value + 180 * kDegree) % (360 * kDegree) + 360 * kDegree) % (360 * kDegree) - 180 * kDegree;
  }
  const int64_t size = std::abs(value);
  std::string name = fmt::format("{}\xB0", size / kDegree);
  if (step < kDegree) name += fmt::format("{:02}'", size % kDegree / kMinute);
  if (step < kMinute) name += fmt::format("{:02}", size % kMinute / kSecond);
  if (step < kSecond) name += fmt::format(".{:02}", size % kSecond);
  if (step < kMinute) name += '"';
  if (size == 0 || size == 180 * kDegree) return name;
  return name + (is_latitude ? (value > 0 ? 'N' : 'S') : (value > 0 ? 'E' : 'W'));
}

std::unique_ptr<ImagePage> DrawGraticule(Quadcode node, const PageText& text) {
  const GeoBox box = node.Box();
  const int64_t step = GridStep(node.level());
  const Lines latitudes(box.south_deg, node.HeightDegrees(), step, true);
  const Lines longitudes(box.west_deg, node.WidthDegrees(), step, false);
  const std::array<float, kImageSide> of_row = latitudes.Covers();
  const std::array<float, kImageSide> of_column = longitudes.Covers();
  auto page = MakeTransparentPage(kLine);
  for (size_t row = 0; row < kImageSide; ++row) {
    for (size_t column = 0; column < kImageSide; ++column) {
      const float cover = std::max(of_row[row], of_column[column]);
      page->texels[4 * (row * kImageSide + column) + 3] = static_cast<uint8_t>(255 * cover + 0.5F);
    }
  }
  WriteNames(*page, latitudes, longitudes, text);
  FillMipLevels(*page);
  return page;
}

}  // namespace belvedere
