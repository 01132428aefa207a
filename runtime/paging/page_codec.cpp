#include "runtime/paging/page_codec.h"

#include "runtime/earth/bisection.h"

#include <zstd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace belvedere {
namespace {

constexpr uint8_t kCodecVersion = 1;
constexpr uint8_t kKindElevation = 1;
constexpr uint8_t kKindImage = 2;
constexpr uint16_t kFlagAlpha = 1;
constexpr uint16_t kFlagDeltas = 2;
constexpr size_t kCheckedHeaderBytes = 16;
constexpr int kElevationZstdLevel = 3;
constexpr int kImageZstdLevel = 1;
constexpr size_t kHeights = static_cast<size_t>(kElevationSide) * static_cast<size_t>(kElevationSide);
constexpr size_t kElevationNumbers = 3 + ErrorBlocks{}.size();
constexpr size_t kElevationRawBytes = kElevationNumbers * sizeof(float) + 4 * kHeights;
constexpr size_t kDeltaRawBytes = sizeof(float) + kVerticesPerPage;

using Crc32cTables = std::array<std::array<uint32_t, 256>, 8>;

constexpr Crc32cTables MakeCrc32cTables() {
  constexpr uint32_t kReversedPolynomial = 0x82F63B78u;
  Crc32cTables tables{};
  for (uint32_t byte = 0; byte < 256; ++byte) {
    uint32_t crc = byte;
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1) != 0 ? kReversedPolynomial : 0);
    tables[0][byte] = crc;
  }
  for (size_t k = 1; k < 8; ++k) {
    for (size_t byte = 0; byte < 256; ++byte) {
      const uint32_t before = tables[k - 1][byte];
      tables[k][byte] = (before >> 8) ^ tables[0][before & 0xFF];
    }
  }
  return tables;
}

void PutU16(std::vector<uint8_t>& out, uint16_t value) {
  out.push_back(static_cast<uint8_t>(value & 0xFF));
  out.push_back(static_cast<uint8_t>(value >> 8));
}
void PutU32(std::vector<uint8_t>& out, uint32_t value) {
  PutU16(out, static_cast<uint16_t>(value & 0xFFFF));
  PutU16(out, static_cast<uint16_t>(value >> 16));
}
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

// One zstd context a thread: creating one costs as much as a small page.
struct CompressionContext {
  ZSTD_CCtx* context = ZSTD_createCCtx();
  ~CompressionContext() { ZSTD_freeCCtx(context); }
};
struct DecompressionContext {
  ZSTD_DCtx* context = ZSTD_createDCtx();
  ~DecompressionContext() { ZSTD_freeDCtx(context); }
};

std::vector<uint8_t> Wrap(uint8_t kind, uint16_t flags, std::span<const uint8_t> raw, int zstd_level) {
  thread_local CompressionContext compression;
  std::vector<uint8_t> payload(ZSTD_compressBound(raw.size()));
  const size_t size =
      ZSTD_compressCCtx(compression.context, payload.data(), payload.size(), raw.data(), raw.size(), zstd_level);
  BELVEDERE_CHECK(ZSTD_isError(size) == 0);
  std::vector<uint8_t> out;
  out.reserve(kPageHeaderBytes + size);
  for (const char c : {'B', 'V', 'P', 'G'}) out.push_back(static_cast<uint8_t>(c));
  out.push_back(kCodecVersion);
  out.push_back(kind);
  PutU16(out, flags);
  PutU32(out, static_cast<uint32_t>(raw.size()));
  PutU32(out, static_cast<uint32_t>(size));
  const std::span<const uint8_t> body(payload.data(), size);
  PutU32(out, Crc32c(body, Crc32c(std::span<const uint8_t>(out).first(kCheckedHeaderBytes))));
  out.insert(out.end(), body.begin(), body.end());
  return out;
}

Status CheckHeader(std::span<const uint8_t> bytes, uint8_t kind) {
  if (bytes.size() < kPageHeaderBytes)
    return Status::Error("page of {} bytes is shorter than its header", bytes.size());
  if (std::memcmp(bytes.data(), "BVPG", 4) != 0) return Status::Error("page does not start with its mark BVPG");
  if (bytes[4] != kCodecVersion) {
    return Status::Error("page of version {}, this program reads version {}", bytes[4], kCodecVersion);
  }
  if (bytes[5] != kind) return Status::Error("page of kind {} where kind {} was expected", bytes[5], kind);
  if (GetU32(&bytes[12]) != bytes.size() - kPageHeaderBytes) return Status::Error("page is cut short or too long");
  const uint32_t crc = Crc32c(bytes.subspan(kPageHeaderBytes), Crc32c(bytes.first(kCheckedHeaderBytes)));
  if (crc != GetU32(&bytes[16])) return Status::Error("checksum does not match");
  return {};
}

// The raw bytes in a buffer that the thread keeps.
Result<std::span<const uint8_t>> Unwrap(std::span<const uint8_t> bytes, size_t raw_size) {
  thread_local DecompressionContext decompression;
  thread_local std::vector<uint8_t> raw;
  if (GetU32(&bytes[8]) != raw_size)
    return Status::Error("raw size {} where {} was expected", GetU32(&bytes[8]), raw_size);
  raw.resize(raw_size);
  const auto payload = bytes.subspan(kPageHeaderBytes);
  const size_t size =
      ZSTD_decompressDCtx(decompression.context, raw.data(), raw.size(), payload.data(), payload.size());
  if (ZSTD_isError(size) != 0) return Status::Error("payload does not decompress: {}", ZSTD_getErrorName(size));
  if (size != raw_size) return Status::Error("payload decompresses to {} bytes, not {}", size, raw_size);
  return std::span<const uint8_t>(raw);
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

uint32_t Crc32c(std::span<const uint8_t> bytes, uint32_t crc) {
  static constexpr Crc32cTables kTables = MakeCrc32cTables();
  crc = ~crc;
  size_t at = 0;
  for (; at + 8 <= bytes.size(); at += 8) {
    const uint32_t low = crc ^ GetU32(&bytes[at]);
    const uint32_t high = GetU32(&bytes[at + 4]);
    crc = kTables[7][low & 0xFF] ^ kTables[6][(low >> 8) & 0xFF] ^ kTables[5][(low >> 16) & 0xFF] ^
          kTables[4][low >> 24] ^ kTables[3][high & 0xFF] ^ kTables[2][(high >> 8) & 0xFF] ^
          kTables[1][(high >> 16) & 0xFF] ^ kTables[0][high >> 24];
  }
  for (; at < bytes.size(); ++at) crc = (crc >> 8) ^ kTables[0][(crc ^ bytes[at]) & 0xFF];
  return ~crc;
}

std::vector<uint8_t> EncodeElevation(const ElevationPage& page) {
  BELVEDERE_CHECK(page.heights_mm.size() == kHeights);
  constexpr size_t kSide = static_cast<size_t>(kElevationSide);
  const bool has_deltas = !page.deltas.steps.empty();
  std::vector<uint8_t> raw(kElevationRawBytes + (has_deltas ? kDeltaRawBytes : 0));
  std::array<float, kElevationNumbers> numbers{page.min_m, page.max_m, page.error_m};
  std::copy(page.block_errors_m.begin(), page.block_errors_m.end(), numbers.begin() + 3);
  for (size_t i = 0; i < numbers.size(); ++i) SetFloat(&raw[4 * i], numbers[i]);
  uint8_t* planes = raw.data() + kElevationNumbers * sizeof(float);
  for (size_t row = 0; row < kSide; ++row) {
    uint32_t step_before = 0;
    for (size_t column = 0; column < kSide; ++column) {
      const size_t at = row * kSide + column;
      const uint32_t below = row > 0 ? static_cast<uint32_t>(page.heights_mm[at - kSide]) : 0;
      const uint32_t step = static_cast<uint32_t>(page.heights_mm[at]) - below;
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
  return Wrap(kKindElevation, has_deltas ? kFlagDeltas : uint16_t{0}, raw, kElevationZstdLevel);
}

Result<std::shared_ptr<ElevationPage>> DecodeElevation(std::span<const uint8_t> bytes) {
  if (Status status = CheckHeader(bytes, kKindElevation); !status.ok()) return status;
  const bool has_deltas = (bytes[6] & kFlagDeltas) != 0;
  const auto raw = Unwrap(bytes, kElevationRawBytes + (has_deltas ? kDeltaRawBytes : 0));
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
  return Wrap(kKindImage, opaque ? uint16_t{0} : kFlagAlpha, raw, kImageZstdLevel);
}

Result<std::shared_ptr<ImagePage>> DecodeImage(std::span<const uint8_t> bytes) {
  if (Status status = CheckHeader(bytes, kKindImage); !status.ok()) return status;
  const bool has_alpha = (bytes[6] & kFlagAlpha) != 0;
  const size_t count = has_alpha ? 4 : 3;
  const auto raw = Unwrap(bytes, count * kImageTexels);
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

}  // namespace belvedere
