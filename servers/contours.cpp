#include "servers/contours.h"

#include "servers/mip_levels.h"
#include "servers/texel_heights.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace belvedere {
namespace {

constexpr int kEvery = 5;  // this many lines, one is heavier
constexpr TexelColour kLand = {122, 66, 22};
constexpr TexelColour kSea = {36, 84, 170};
constexpr TexelColour kLandText = {84, 40, 8};
constexpr TexelColour kSeaText = {16, 48, 120};
constexpr TexelColour kCoast = {8, 26, 96};
constexpr TexelColour kHalo = {250, 246, 236};

// Half of each kind's width, in texels.
constexpr float kThin = 0.4F;
constexpr float kHeavy = 0.8F;
constexpr float kCoastal = 1.2F;
constexpr float kThinCover = 0.7F;

// Lines fade out between these numbers of lines a texel,
constexpr float kClear = 0.2F;
constexpr float kCrowded = 0.4F;
// and on flat ground between these.
constexpr float kFlat = 0.0005F;
constexpr float kSloping = 0.002F;

constexpr int kBlocks = 2;              // along each side, each with one height at most
constexpr int kSearchStep = 3;          // texels between places that are tried
constexpr float kMostBent = 12;         // texels that a line may leave its text, both ends together
constexpr float kMostLabelled = 0.07F;  // heavy lines a texel, where they have heights
constexpr float kFarPerTexel = 0.04F;   // texels of bend that a texel's distance from the block's middle weighs

struct Intervals {
  float thin_m = 0, heavy_m = 0;
};

float Fade(float value, float none, float all) {
  return std::clamp((value - none) / (all - none), 0.0F, 1.0F);
}

// How much of a texel the line nearest to it covers. gradient: metres a texel.
float Cover(float height_m, float gradient, float interval_m, float half_width) {
  const float off_m = std::abs(height_m - interval_m * std::nearbyint(height_m / interval_m));
  if (off_m >= gradient * (half_width + 0.5F)) return 0;  // level ground too, also at a line's height
  const float cover = std::min(half_width + 0.5F - off_m / gradient, 1.0F);
  return cover * Fade(gradient / interval_m, kCrowded, kClear);
}

float Gradient(const TexelHeight& at) {
  constexpr auto kPerTexel = static_cast<float>(kPostsPerTexel);
  return kPerTexel * std::sqrt(at.rise_east_m * at.rise_east_m + at.rise_north_m * at.rise_north_m);
}

void DrawLines(ImagePage& page, const std::vector<TexelHeight>& ground, const Intervals& intervals) {
  uint8_t* texel = page.texels.data();
  for (const TexelHeight& at : ground) {
    const float gradient = Gradient(at);
    const float thin = kThinCover * Cover(at.height_m, gradient, intervals.thin_m, kThin);
    const float heavy = Cover(at.height_m, gradient, intervals.heavy_m, kHeavy);
    const float coast = std::abs(at.height_m) < 0.5F * intervals.thin_m
                            ? Cover(at.height_m, gradient, intervals.heavy_m * kEvery, kCoastal)
                            : 0.0F;
    const float cover = std::max({thin, heavy, coast}) * Fade(gradient / intervals.thin_m, kFlat, kSloping);
    const TexelColour& colour = coast > 0 ? kCoast : at.height_m < 0 ? kSea : kLand;
    texel = std::ranges::copy(colour, texel).out;
    *texel++ = static_cast<uint8_t>(255 * cover + 0.5F);
  }
}

struct Label {
  std::string text;
  TexelBox box;
  TexelColour ink;
  float bent = kMostBent;  // less is better
};

class Labels {
 public:
  Labels(const std::vector<TexelHeight>& ground, const Intervals& intervals, const PageText& text)
      : ground_(ground), heavy_m_(intervals.heavy_m), text_(text) {}

  // The best place in a square of texels.
  std::optional<Label> Best(int west, int south, int side) const {
    std::optional<Label> best;
    for (int row = south; row < south + side; row += kSearchStep) {
      for (int column = west; column < west + side; column += kSearchStep) {
        std::optional<Label> label = At(column, row);
        if (!label) continue;
        const auto far = static_cast<float>(std::abs(column - west - side / 2) + std::abs(row - south - side / 2));
        label->bent += kFarPerTexel * far;
        if (!best || label->bent < best->bent) best = std::move(label);
      }
    }
    return best;
  }

 private:
  const TexelHeight& Ground(int column, int row) const {
    return ground_[static_cast<size_t>(row * kImageSide + column)];
  }

  std::optional<Label> At(int column, int row) const {
    const TexelHeight& at = Ground(column, row);
    const float gradient = Gradient(at);
    const float line_m = heavy_m_ * std::nearbyint(at.height_m / heavy_m_);
    if (line_m == 0 || std::abs(at.height_m - line_m) >= gradient * kHeavy || gradient > kMostLabelled * heavy_m_) {
      return std::nullopt;
    }
    const std::string text = fmt::format("{:.8g}", line_m);
    const TexelBox box = text_.BoxAround(text, column, row);
    if (box.west < kInnerTexels.west || box.south < kInnerTexels.south || box.east > kInnerTexels.east ||
        box.north > kInnerTexels.north) {
      return std::nullopt;
    }
    const float bent =
        (std::abs(Ground(box.west, row).height_m - line_m) + std::abs(Ground(box.east - 1, row).height_m - line_m)) /
        gradient;
    if (bent > kMostBent) return std::nullopt;
    return Label{text, box, line_m < 0 ? kSeaText : kLandText, bent};
  }

  const std::vector<TexelHeight>& ground_;
  const float heavy_m_;
  const PageText& text_;
};

void WriteHeights(ImagePage& page, const std::vector<TexelHeight>& ground, const Intervals& intervals,
                  const PageText& text) {
  const Labels labels(ground, intervals, text);
  constexpr int kSide = kImageInner / kBlocks;
  std::vector<TexelBox> taken;
  for (int block = 0; block < kBlocks * kBlocks; ++block) {
    const int west = kImageGutter + block % kBlocks * kSide;
    const int south = kImageGutter + block / kBlocks * kSide;
    const std::optional<Label> label = labels.Best(west, south, kSide);
    if (!label || std::ranges::any_of(taken, [&](const TexelBox& box) { return box.Meets(label->box); })) continue;
    text.Write(page, label->box, label->text, label->ink, kHalo);
    taken.push_back(label->box);
  }
}

}  // namespace

double ContourInterval(int level) {
  // Coarse levels have gentle slopes, as their posts lie far apart, so their intervals grow slower than their texels.
  constexpr std::array<double, kMaxLevel + 1> kIntervals_m = {
      1000, 1000, 1000, 1000, 1000, 500, 500, 200, 200, 100, 50, 50, 20, 20, 10, 10, 5, 5, 2, 2, 1, 1, 0.5};
  return kIntervals_m[static_cast<size_t>(level)];
}

std::unique_ptr<ImagePage> DrawContours(const ElevationPage& heights, Quadcode node, const Geoid* sea,
                                        const PageText& text) {
  auto page = std::make_unique<ImagePage>();
  page->texels.resize(ImagePage::MipOffset(kImageMipLevels, page->format));
  const auto thin_m = static_cast<float>(ContourInterval(node.level()));
  const Intervals intervals{thin_m, kEvery * thin_m};
  const std::vector<TexelHeight> ground = HeightsAtTexels(heights, node, sea);
  DrawLines(*page, ground, intervals);
  if (text.font().ok()) WriteHeights(*page, ground, intervals, text);
  FillMipLevels(*page);
  return page;
}

}  // namespace belvedere
