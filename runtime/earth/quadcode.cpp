#include "runtime/earth/quadcode.h"

#include "runtime/base/status.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>

namespace belvedere {
namespace {

constexpr double kDegreesPerUnit = kTreeDegrees / static_cast<double>(uint64_t{1} << kGridBitsPerTree);

// Code of the first node of a level: (4^level - 1) / 3.
constexpr uint64_t FirstCode(int level) {
  return ((uint64_t{1} << (2 * level)) - 1) / 3;
}

// Spreads the low 32 bits to the even bits (Morton order), and gathers them again.
constexpr uint64_t Spread(uint64_t v) {
  v &= 0xFFFFFFFFu;
  v = (v | (v << 16)) & 0x0000FFFF0000FFFFu;
  v = (v | (v << 8)) & 0x00FF00FF00FF00FFu;
  v = (v | (v << 4)) & 0x0F0F0F0F0F0F0F0Fu;
  v = (v | (v << 2)) & 0x3333333333333333u;
  return (v | (v << 1)) & 0x5555555555555555u;
}
constexpr uint64_t Gather(uint64_t v) {
  v &= 0x5555555555555555u;
  v = (v | (v >> 1)) & 0x3333333333333333u;
  v = (v | (v >> 2)) & 0x0F0F0F0F0F0F0F0Fu;
  v = (v | (v >> 4)) & 0x00FF00FF00FF00FFu;
  v = (v | (v >> 8)) & 0x0000FFFF0000FFFFu;
  return (v | (v >> 16)) & 0xFFFFFFFFu;
}

}  // namespace

double GridPoint::longitude_deg() const {
  return static_cast<double>(x) * kDegreesPerUnit - 180.0;
}
double GridPoint::latitude_deg() const {
  return static_cast<double>(y) * kDegreesPerUnit - 90.0;
}

int Quadcode::level() const {
  // 3 * code + 1 lies in [4^level, 4^(level+1))
  return static_cast<int>((std::bit_width(3 * code() + 1) - 1) / 2);
}

Quadcode Quadcode::FromColumnRow(int level, int64_t column, int64_t row) {
  BELVEDERE_CHECK(level >= 0 && level <= kMaxLevel);
  const int64_t columns = int64_t{kTreeColumns} << level;
  const int64_t rows = int64_t{kTreeRows} << level;
  BELVEDERE_CHECK(row >= 0 && row < rows);
  column = ((column % columns) + columns) % columns;
  const int64_t in_tree = int64_t{1} << level;
  const auto tree = static_cast<uint64_t>((row / in_tree) * kTreeColumns + column / in_tree);
  const auto x = static_cast<uint64_t>(column % in_tree);
  const auto y = static_cast<uint64_t>(row % in_tree);
  return Quadcode((tree << kTreeShift) | (FirstCode(level) + (Spread(x) | (Spread(y) << 1))));
}

Quadcode Quadcode::Containing(double latitude_deg, double longitude_deg, int level) {
  const double nodes_per_degree = std::ldexp(1.0, level) / kTreeDegrees;
  const auto column = static_cast<int64_t>(std::floor((longitude_deg + 180.0) * nodes_per_degree));
  const auto row = static_cast<int64_t>(std::floor((latitude_deg + 90.0) * nodes_per_degree));
  return FromColumnRow(level, column, std::clamp<int64_t>(row, 0, (int64_t{kTreeRows} << level) - 1));
}

std::optional<Quadcode> Quadcode::FromWord(uint64_t word) {
  if ((word & kCodeMask) >= FirstCode(kMaxLevel + 1)) return std::nullopt;
  return Quadcode(word);
}

Quadcode Quadcode::Ancestor(int level) const {
  const int own = this->level();
  BELVEDERE_CHECK(level >= 0 && level <= own);
  const uint64_t within = code() - FirstCode(own);
  return Quadcode((word_ & ~kCodeMask) | (FirstCode(level) + (within >> (2 * (own - level)))));
}

bool Quadcode::Contains(Quadcode other) const {
  const int own = level();
  return other.tree() == tree() && other.level() >= own && other.Ancestor(own) == *this;
}

int64_t Quadcode::column() const {
  const int own = level();
  const auto x = static_cast<int64_t>(Gather(code() - FirstCode(own)));
  return (int64_t{tree() % kTreeColumns} << own) + x;
}

int64_t Quadcode::row() const {
  const int own = level();
  const auto y = static_cast<int64_t>(Gather((code() - FirstCode(own)) >> 1));
  return (int64_t{tree() / kTreeColumns} << own) + y;
}

GridPoint Quadcode::SouthWest() const {
  const int shift = kGridBitsPerTree - level();
  return {static_cast<uint32_t>(column() << shift), static_cast<uint32_t>(row() << shift)};
}

double Quadcode::SizeDegrees() const {
  return std::ldexp(kTreeDegrees, -level());
}

GeoBox Quadcode::Box() const {
  const double size = SizeDegrees();
  const double west = static_cast<double>(column()) * size - 180.0;
  const double south = static_cast<double>(row()) * size - 90.0;
  return {west, south, west + size, south + size};
}

std::string Quadcode::ToString() const {
  std::string text = fmt::format("{}:", tree());
  for (int level = 1; level <= this->level(); ++level) text += static_cast<char>('0' + Ancestor(level).WhichChild());
  return text;
}

std::optional<Quadcode> Quadcode::Parse(std::string_view text) {
  const size_t colon = text.find(':');
  if (colon == std::string_view::npos || text.size() - colon - 1 > kMaxLevel) return std::nullopt;
  int tree = -1;
  const auto parsed = std::from_chars(text.data(), text.data() + colon, tree);
  if (parsed.ec != std::errc() || parsed.ptr != text.data() + colon || tree < 0 || tree >= kTrees) return std::nullopt;
  Quadcode node = Root(tree);
  for (const char digit : text.substr(colon + 1)) {
    if (digit < '0' || digit > '3') return std::nullopt;
    node = node.Child(digit - '0');
  }
  return node;
}

}  // namespace belvedere
