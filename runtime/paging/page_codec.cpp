#include "runtime/paging/page_codec.h"

#include "runtime/earth/bisection.h"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

namespace belvedere {
namespace {

constexpr uint8_t kKindElevation = 1;
constexpr uint8_t kKindImage = 2;
constexpr uint8_t kKindProperty = 4;
constexpr uint16_t kFlagAlpha = 1;
constexpr uint16_t kFlagDeltas = 2;
constexpr int kShiftOfHeights = 8;  // place in the flags of how many low bits all heights have as 0
constexpr uint8_t kShiftMask = 31;
constexpr int kElevationZstdLevel = 3;
constexpr int kImageZstdLevel = 1;
constexpr int kPropertyZstdLevel = 3;
constexpr size_t kHeights = static_cast<size_t>(kElevationSide) * static_cast<size_t>(kElevationSide);
constexpr size_t kElevationNumbers = 3 + ErrorBlocks{}.size();
constexpr size_t kElevationRawBytes = kElevationNumbers * sizeof(float) + 4 * kHeights;
constexpr size_t kDeltaRawBytes = sizeof(float) + kVerticesPerPage;

uint32_t GetU32(const uint8_t* bytes) {
  return static_cast<uint32_t>(bytes[0]) | static_cast<uint32_t>(bytes[1]) << 8 |
         static_cast<uint32_t>(bytes[2]) << 16 | static_cast<uint32_t>(bytes[3]) << 24;
}

void SetFloat(uint8_t* bytes, float value) {
  const auto bits = std::bit_cast<uint32_t>(value);
  for (size_t byte = 0; byte < 4; ++byte) bytes[byte] = static_cast<uint8_t>(bits >> (8 * byte));
}
float GetFloat(const uint8_t* bytes) {
  return std::bit_cast<float>(GetU32(bytes));
}

constexpr uint32_t ZigZag(uint32_t v) {
  return (v << 1) ^ (0u - (v >> 31));
}
constexpr uint32_t UnZigZag(uint32_t v) {
  return (v >> 1) ^ (0u - (v & 1));
}

// Median edge predictor (Weinberger, Seroussi, Sapiro: LOCO-I, 1996): the planar guess, clamped to its neighbours.
inline uint8_t Predict(uint8_t left, uint8_t below, uint8_t below_left) {
  const int lowest = std::min(left, below);
  const int highest = std::max(left, below);
  return static_cast<uint8_t>(std::clamp(left + below - below_left, lowest, highest));
}

void EncodePlane(const std::vector<uint8_t>& plane, uint8_t* out) {
  constexpr size_t kSide = static_cast<size_t>(kImageSide);
  for (size_t row = 0; row < kSide; ++row) {
    for (size_t column = 0; column < kSide; ++column) {
      const size_t at = row * kSide + column;
      const uint8_t left = column > 0 ? plane[at - 1] : uint8_t{0};
      const uint8_t below = row > 0 ? plane[at - kSide] : uint8_t{0};
      const uint8_t guess = row == 0 ? left : column == 0 ? below : Predict(left, below, plane[at - kSide - 1]);
      out[at] = static_cast<uint8_t>(plane[at] - guess);
    }
  }
}

void DecodePlane(const uint8_t* residuals, std::vector<uint8_t>& plane) {
  constexpr size_t kSide = static_cast<size_t>(kImageSide);
  plane.resize(kImageTexels);
  uint8_t left = 0;
  for (size_t column = 0; column < kSide; ++column)
    plane[column] = left = static_cast<uint8_t>(residuals[column] + left);
  for (size_t row = 1; row < kSide; ++row) {
    const uint8_t* in = residuals + row * kSide;
    const uint8_t* below = plane.data() + (row - 1) * kSide;
    uint8_t* out = plane.data() + row * kSide;
    out[0] = left = static_cast<uint8_t>(in[0] + below[0]);
    for (size_t column = 1; column < kSide; ++column) {
      left = static_cast<uint8_t>(in[column] + Predict(left, below[column], below[column - 1]));
      out[column] = left;
    }
  }
}

// How many of the lowest bits are 0 in all heights: they are rounded to that power of two.
int ZeroBits(std::span<const int32_t> heights_mm) {
  uint32_t any = 0;
  for (const int32_t height_mm : heights_mm) any |= static_cast<uint32_t>(height_mm);
  return any == 0 ? 0 : std::countr_zero(any);
}

// A post's step is told from the parent with the greater delta value. Level by level, so that the parents come first.
uint8_t GuessStep(const std::vector<uint8_t>& steps, Post post) {
  const Split split = SplitAt(post);
  const uint8_t a = split.apex_a.inside() ? steps[static_cast<size_t>(split.apex_a.index())] : uint8_t{255};
  const uint8_t b = split.apex_b.inside() ? steps[static_cast<size_t>(split.apex_b.index())] : uint8_t{255};
  return std::min(a, b);
}

void PutSteps(const std::vector<uint8_t>& steps, uint8_t* out) {
  for (const Post corner : kCorners) *out++ = steps[static_cast<size_t>(corner.index())];
  for (int level = 0; level < kBisectionLevels; ++level) {
    ForEachPost(level, [&](Post post) {
      *out++ = static_cast<uint8_t>(steps[static_cast<size_t>(post.index())] - GuessStep(steps, post));
    });
  }
}

std::vector<uint8_t> GetSteps(const uint8_t* in) {
  std::vector<uint8_t> steps(kVerticesPerPage);
  for (const Post corner : kCorners) steps[static_cast<size_t>(corner.index())] = *in++;
  for (int level = 0; level < kBisectionLevels; ++level) {
    ForEachPost(level, [&](Post post) {
      steps[static_cast<size_t>(post.index())] = static_cast<uint8_t>(*in++ + GuessStep(steps, post));
    });
  }
  return steps;
}

}  // namespace

std::vector<uint8_t> EncodeElevation(const ElevationPage& page) {
  BELVEDERE_CHECK(page.heights_mm.size() == kHeights);
  constexpr size_t kSide = static_cast<size_t>(kElevationSide);
  const bool has_deltas = !page.deltas.steps.empty();
  std::vector<uint8_t> raw(kElevationRawBytes + (has_deltas ? kDeltaRawBytes : 0));
  std::array<float, kElevationNumbers> numbers{page.min_m, page.max_m, page.error_m};
  std::copy(page.block_errors_m.begin(), page.block_errors_m.end(), numbers.begin() + 3);
  for (size_t i = 0; i < numbers.size(); ++i) SetFloat(&raw[4 * i], numbers[i]);
  uint8_t* planes = raw.data() + kElevationNumbers * sizeof(float);
  const int zero_bits = ZeroBits(page.heights_mm);
  const auto height_at = [&](size_t at) { return static_cast<uint32_t>(page.heights_mm[at] >> zero_bits); };
  for (size_t row = 0; row < kSide; ++row) {
    uint32_t step_before = 0;
    for (size_t column = 0; column < kSide; ++column) {
      const size_t at = row * kSide + column;
      const uint32_t below = row > 0 ? height_at(at - kSide) : 0;
      const uint32_t step = height_at(at) - below;
      const uint32_t residual = ZigZag(step - step_before);
      step_before = step;
      for (size_t byte = 0; byte < 4; ++byte)
        planes[byte * kHeights + at] = static_cast<uint8_t>(residual >> (8 * byte));
    }
  }
  if (has_deltas) {
    BELVEDERE_CHECK(page.deltas.steps.size() == kVerticesPerPage);
    uint8_t* deltas = raw.data() + kElevationRawBytes;
    SetFloat(deltas, page.deltas.greatest_m);
    PutSteps(page.deltas.steps, deltas + sizeof(float));
  }
  const auto flags = static_cast<uint16_t>(zero_bits << kShiftOfHeights | (has_deltas ? kFlagDeltas : 0));
  return WrapPage(kKindElevation, flags, raw, kElevationZstdLevel);
}

Result<std::shared_ptr<ElevationPage>> DecodeElevation(std::span<const uint8_t> bytes) {
  if (Status status = CheckPageHeader(bytes, kKindElevation); !status.ok()) return status;
  const bool has_deltas = (bytes[6] & kFlagDeltas) != 0;
  const uint32_t zero_bits = bytes[7] & kShiftMask;
  const auto raw = UnwrapPage(bytes, kElevationRawBytes + (has_deltas ? kDeltaRawBytes : 0));
  if (!raw.ok()) return raw.status();
  constexpr size_t kSide = static_cast<size_t>(kElevationSide);
  auto page = std::make_shared<ElevationPage>();
  page->min_m = GetFloat(raw->data());
  page->max_m = GetFloat(raw->data() + 4);
  page->error_m = GetFloat(raw->data() + 8);
  for (size_t i = 0; i < page->block_errors_m.size(); ++i)
    page->block_errors_m[i] = GetFloat(raw->data() + 4 * (3 + i));
  page->heights_mm.resize(kHeights);
  const uint8_t* planes = raw->data() + kElevationNumbers * sizeof(float);
  for (size_t row = 0; row < kSide; ++row) {
    uint32_t step = 0;
    for (size_t column = 0; column < kSide; ++column) {
      const size_t at = row * kSide + column;
      const uint32_t residual = static_cast<uint32_t>(planes[at]) | static_cast<uint32_t>(planes[kHeights + at]) << 8 |
                                static_cast<uint32_t>(planes[2 * kHeights + at]) << 16 |
                                static_cast<uint32_t>(planes[3 * kHeights + at]) << 24;
      step += UnZigZag(residual);
      const uint32_t below = row > 0 ? static_cast<uint32_t>(page->heights_mm[at - kSide]) : 0;
      page->heights_mm[at] = static_cast<int32_t>(below + step);
    }
  }
  if (zero_bits > 0) {
    for (int32_t& height_mm : page->heights_mm)
      height_mm = static_cast<int32_t>(static_cast<uint32_t>(height_mm) << zero_bits);
  }
  if (has_deltas) {
    const std::span<const uint8_t> deltas = raw->subspan(kElevationRawBytes);
    page->deltas.greatest_m = GetFloat(deltas.data());
    page->deltas.steps = GetSteps(deltas.data() + sizeof(float));
  }
  return page;
}

std::vector<uint8_t> EncodeImage(std::span<const uint8_t> rgba) {
  BELVEDERE_CHECK(rgba.size() == 4 * kImageTexels);
  std::array<std::vector<uint8_t>, 4> planes;
  for (auto& plane : planes) plane.resize(kImageTexels);
  bool opaque = true;
  for (size_t i = 0; i < kImageTexels; ++i) {
    const uint8_t green = rgba[4 * i + 1];
    planes[0][i] = green;
    planes[1][i] = static_cast<uint8_t>(rgba[4 * i] - green);
    planes[2][i] = static_cast<uint8_t>(rgba[4 * i + 2] - green);
    planes[3][i] = rgba[4 * i + 3];
    opaque = opaque && planes[3][i] == 255;
  }
  const size_t count = opaque ? 3 : 4;
  std::vector<uint8_t> raw(count * kImageTexels);
  for (size_t plane = 0; plane < count; ++plane) EncodePlane(planes[plane], raw.data() + plane * kImageTexels);
  return WrapPage(kKindImage, opaque ? uint16_t{0} : kFlagAlpha, raw, kImageZstdLevel);
}

Result<std::shared_ptr<ImagePage>> DecodeImage(std::span<const uint8_t> bytes) {
  if (Status status = CheckPageHeader(bytes, kKindImage); !status.ok()) return status;
  const bool has_alpha = (bytes[6] & kFlagAlpha) != 0;
  const size_t count = has_alpha ? 4 : 3;
  const auto raw = UnwrapPage(bytes, count * kImageTexels);
  if (!raw.ok()) return raw.status();
  thread_local std::array<std::vector<uint8_t>, 4> planes;
  for (size_t plane = 0; plane < count; ++plane) DecodePlane(raw->data() + plane * kImageTexels, planes[plane]);
  auto page = std::make_shared<ImagePage>();
  page->format = ImageFormat::kRGBA8;
  page->texels.resize(ImagePage::MipOffset(kImageMipLevels, ImageFormat::kRGBA8));
  for (size_t i = 0; i < kImageTexels; ++i) {
    const uint8_t green = planes[0][i];
    page->texels[4 * i] = static_cast<uint8_t>(planes[1][i] + green);
    page->texels[4 * i + 1] = green;
    page->texels[4 * i + 2] = static_cast<uint8_t>(planes[2][i] + green);
    page->texels[4 * i + 3] = has_alpha ? planes[3][i] : uint8_t{255};
  }
  return page;
}

std::vector<uint8_t> EncodeProperty(const PropertyPage& page) {
  BELVEDERE_CHECK(page.channels >= 1 && page.channels <= kMostPropertyChannels);
  BELVEDERE_CHECK(page.values.size() == static_cast<size_t>(page.channels) * kHeights);
  std::vector<uint8_t> raw(page.values.size());
  uint8_t before = 0;
  for (size_t i = 0; i < raw.size(); ++i)
    raw[i] = static_cast<uint8_t>(page.values[i] - std::exchange(before, page.values[i]));
  return WrapPage(kKindProperty, static_cast<uint16_t>(page.channels), raw, kPropertyZstdLevel);
}

Result<std::shared_ptr<PropertyPage>> DecodeProperty(std::span<const uint8_t> bytes) {
  if (Status status = CheckPageHeader(bytes, kKindProperty); !status.ok()) return status;
  const int channels = bytes[6] | bytes[7] << 8;
  if (channels < 1 || channels > kMostPropertyChannels) return Status::Error("a property of {} channels", channels);
  const auto raw = UnwrapPage(bytes, static_cast<size_t>(channels) * kHeights);
  if (!raw.ok()) return raw.status();
  auto page = std::make_shared<PropertyPage>();
  page->channels = channels;
  page->values.resize(raw->size());
  uint8_t value = 0;
  for (size_t i = 0; i < raw->size(); ++i) page->values[i] = value = static_cast<uint8_t>(value + (*raw)[i]);
  return page;
}

}  // namespace belvedere
