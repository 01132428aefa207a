#include "render/atlas.h"

#include <ft2build.h>
#include FT_FREETYPE_H

#include <glm/vec2.hpp>

#include <algorithm>
#include <cmath>
#include <span>

namespace belvedere {
namespace {

constexpr int kOutline_px = 2;  // room for the outline around each shape
constexpr int kSymbolSamples = 4;

// The outline with one of the same shape cut out of it: a line around it goes in and comes back where it went.
std::vector<glm::vec2> Ring(std::vector<glm::vec2> outline) {
  constexpr float kInner = 0.84F;
  const size_t count = outline.size();
  outline.push_back(outline.front());
  for (size_t i = 0; i <= count; ++i) outline.push_back(kInner * outline[count - i]);
  return outline;
}

std::vector<glm::vec2> Quatrefoil() {
  constexpr int kPoints = 64;
  std::vector<glm::vec2> outline;
  outline.reserve(kPoints);
  for (int i = 0; i < kPoints; ++i) {
    const float angle = 6.2831853F * static_cast<float>(i) / kPoints;
    const float radius = 0.72F + 0.24F * std::abs(std::cos(2.0F * angle));
    outline.emplace_back(radius * std::sin(angle), radius * std::cos(angle));
  }
  return outline;
}

// Polygons in a square from -1 to 1, x right, y towards where the object is heading.
const std::vector<glm::vec2>& Outline(SymbolShape shape) {
  static const std::vector<glm::vec2> kNothing;
  static const std::vector<glm::vec2> kArrow = {{0, 1}, {0.75F, -0.85F}, {0, -0.45F}, {-0.75F, -0.85F}};
  static const std::vector<glm::vec2> kSquare = {{-0.62F, 0.62F}, {0.62F, 0.62F}, {0.62F, -0.62F}, {-0.62F, -0.62F}};
  static const std::vector<glm::vec2> kHull = {{0, 1}, {0.5F, 0.35F}, {0.5F, -0.9F}, {-0.5F, -0.9F}, {-0.5F, 0.35F}};
  static const std::vector<glm::vec2> kTrough = {{-0.8F, 0.1F}, {0.8F, 0.1F}, {0.5F, -0.7F}, {-0.5F, -0.7F}};
  static const std::vector<glm::vec2> kDiamond = {{0, 0.8F}, {0.8F, 0}, {0, -0.8F}, {-0.8F, 0}};
  static const std::vector<glm::vec2> kFriend = Ring({{-1, 0.66F}, {1, 0.66F}, {1, -0.66F}, {-1, -0.66F}});
  static const std::vector<glm::vec2> kHostile = Ring({{0, 1}, {1, 0}, {0, -1}, {-1, 0}});
  static const std::vector<glm::vec2> kNeutral =
      Ring({{-0.85F, 0.85F}, {0.85F, 0.85F}, {0.85F, -0.85F}, {-0.85F, -0.85F}});
  static const std::vector<glm::vec2> kUnknown = Ring(Quatrefoil());
  switch (shape) {
    case SymbolShape::kFrameFriend: return kFriend;
    case SymbolShape::kFrameHostile: return kHostile;
    case SymbolShape::kFrameNeutral: return kNeutral;
    case SymbolShape::kFrameUnknown: return kUnknown;
    case SymbolShape::kNone: return kNothing;
    case SymbolShape::kAir: return kArrow;
    case SymbolShape::kGround: return kSquare;
    case SymbolShape::kSurface: return kHull;
    case SymbolShape::kSubsurface: return kTrough;
    case SymbolShape::kOther: return kDiamond;
  }
  return kNothing;
}

bool Inside(std::span<const glm::vec2> polygon, glm::vec2 point) {
  bool inside = false;
  for (size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    const glm::vec2 a = polygon[i];
    const glm::vec2 b = polygon[j];
    if ((a.y > point.y) == (b.y > point.y)) continue;
    if (point.x < (b.x - a.x) * (point.y - a.y) / (b.y - a.y) + a.x) inside = !inside;
  }
  return inside;
}

std::vector<uint8_t> CoverOf(std::span<const glm::vec2> polygon, int side) {
  std::vector<uint8_t> cover(static_cast<size_t>(side) * static_cast<size_t>(side));
  const auto at = [&](int texel, int sample) {
    const float step = 1.0F / static_cast<float>(kSymbolSamples);
    return 2.0F * (static_cast<float>(texel) + (static_cast<float>(sample) + 0.5F) * step) / static_cast<float>(side) -
           1.0F;
  };
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      int hits = 0;
      for (int s = 0; s < kSymbolSamples * kSymbolSamples; ++s) {
        hits += Inside(polygon, {at(x, s % kSymbolSamples), -at(y, s / kSymbolSamples)}) ? 1 : 0;
      }
      cover[static_cast<size_t>(y * side + x)] = static_cast<uint8_t>(255 * hits / (kSymbolSamples * kSymbolSamples));
    }
  }
  return cover;
}

// Cover of the shape grown by about a pixel and a half.
uint8_t Grown(const std::vector<uint8_t>& cover, int width, int height, int x, int y) {
  float most = 0;
  for (int dy = -kOutline_px; dy <= kOutline_px; ++dy) {
    for (int dx = -kOutline_px; dx <= kOutline_px; ++dx) {
      const int sx = x + dx;
      const int sy = y + dy;
      if (sx < 0 || sy < 0 || sx >= width || sy >= height) continue;
      const float fade = std::clamp(2.3F - std::sqrt(static_cast<float>(dx * dx + dy * dy)), 0.0F, 1.0F);
      most = std::max(most, fade * static_cast<float>(cover[static_cast<size_t>(sy * width + sx)]));
    }
  }
  return static_cast<uint8_t>(most);
}

}  // namespace

Atlas::Atlas(const std::string& font_path) : texels_(static_cast<size_t>(kWidth) * kHeight * 2) {
  const std::vector<uint8_t> full(8 * 8, 255);
  solid_ = Add(full, 8, 8);
  // The inner texel alone: whatever the size of its quad, no edge is seen.
  const float u = 0.5F * (solid_.u0 + solid_.u1);
  const float v = 0.5F * (solid_.v0 + solid_.v1);
  solid_ = {0, 0, 1, 1, u, v, u, v, 0};
  AddSymbols();
  font_ = AddFont(font_path);
}

AtlasShape Atlas::Add(const std::vector<uint8_t>& cover, int width, int height) {
  const int full_width = width + 2 * kOutline_px;
  const int full_height = height + 2 * kOutline_px;
  if (next_x_ + full_width > kWidth) {
    next_x_ = 0;
    next_y_ += row_height_;
    row_height_ = 0;
  }
  BELVEDERE_CHECK(next_y_ + full_height <= kHeight);
  for (int y = 0; y < full_height; ++y) {
    for (int x = 0; x < full_width; ++x) {
      const int sx = x - kOutline_px;
      const int sy = y - kOutline_px;
      const bool within = sx >= 0 && sy >= 0 && sx < width && sy < height;
      const size_t texel = 2 * static_cast<size_t>((next_y_ + y) * kWidth + next_x_ + x);
      texels_[texel] = within ? cover[static_cast<size_t>(sy * width + sx)] : uint8_t{0};
      texels_[texel + 1] = Grown(cover, width, height, sx, sy);
    }
  }
  AtlasShape shape;
  shape.width = static_cast<float>(full_width);
  shape.height = static_cast<float>(full_height);
  shape.u0 = static_cast<float>(next_x_) / kWidth;
  shape.v0 = static_cast<float>(next_y_) / kHeight;
  shape.u1 = static_cast<float>(next_x_ + full_width) / kWidth;
  shape.v1 = static_cast<float>(next_y_ + full_height) / kHeight;
  next_x_ += full_width;
  row_height_ = std::max(row_height_, full_height);
  return shape;
}

void Atlas::AddSymbols() {
  const int side = static_cast<int>(kSymbolSide_px) - 2 * kOutline_px;
  for (size_t i = 1; i < symbols_.size(); ++i) {
    symbols_[i] = Add(CoverOf(Outline(static_cast<SymbolShape>(i)), side), side, side);
  }
}

Status Atlas::AddFont(const std::string& path) {
  FT_Library library = nullptr;
  if (FT_Init_FreeType(&library) != 0) return Status::Error("FreeType cannot be started; labels are not shown");
  FT_Face face = nullptr;
  if (FT_New_Face(library, path.c_str(), 0, &face) != 0 || FT_Set_Pixel_Sizes(face, 0, kFontHeight_px) != 0) {
    if (face != nullptr) FT_Done_Face(face);
    FT_Done_FreeType(library);
    return Status::Error("{}: cannot read the font, labels are not shown; install fonts-dejavu-core or set font", path);
  }
  for (unsigned code = 32; code < 256; ++code) {
    if ((code >= 127 && code < 160) || FT_Load_Char(face, code, FT_LOAD_RENDER) != 0) continue;
    const FT_GlyphSlot glyph = face->glyph;
    const int width = static_cast<int>(glyph->bitmap.width);
    const int height = static_cast<int>(glyph->bitmap.rows);
    std::vector<uint8_t> cover;
    for (int row = 0; row < height; ++row) {
      const uint8_t* line = glyph->bitmap.buffer + row * glyph->bitmap.pitch;
      cover.insert(cover.end(), line, line + width);
    }
    AtlasShape shape = Add(cover, width, height);
    shape.left = static_cast<float>(glyph->bitmap_left - kOutline_px);
    shape.top = static_cast<float>(-glyph->bitmap_top - kOutline_px);
    shape.advance = static_cast<float>(glyph->advance.x) / 64.0F;
    glyphs_[code] = shape;
  }
  FT_Done_Face(face);
  FT_Done_FreeType(library);
  return {};
}

float Atlas::WidthOf(std::string_view latin1) const {
  float width = 0;
  for (const char c : latin1) width += Glyph(static_cast<unsigned char>(c)).advance;
  return width;
}

std::string ToLatin1(std::string_view utf8) {
  std::string latin1;
  for (size_t i = 0; i < utf8.size(); ++i) {
    const auto byte = static_cast<unsigned char>(utf8[i]);
    if (byte < 0x80) {
      latin1.push_back(utf8[i]);
    } else if ((byte == 0xC2 || byte == 0xC3) && i + 1 < utf8.size()) {
      latin1.push_back(static_cast<char>(((byte & 0x03U) << 6U) | (static_cast<unsigned char>(utf8[++i]) & 0x3FU)));
    } else if (byte >= 0xC0) {
      latin1.push_back('?');  // the bytes that go on with it are dropped below
    }
  }
  return latin1;
}

}  // namespace belvedere
