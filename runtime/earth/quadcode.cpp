#include "runtime/earth/quadcode.h"

#include "runtime/base/status.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
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

// Of the quadnodes of a row: how many times wider than tall, as a power of two. Rows in the half of a root at a pole
// are wide: that at the pole as its root is; those of a child beside the pole, and all under it, as that child makes
// them.
int DoublingsIn(int level, int64_t row) {
  const int64_t rows = int64_t{kTreeRows} << level;
  const auto from_pole = static_cast<uint64_t>(std::min(row, rows - 1 - row));
  // The quadnode so many levels up touches the pole.
  const auto levels_since_pole = static_cast<int>(std::bit_width(from_pole));
  if (levels_since_pole >= level) return 0;
  return levels_since_pole == 0 ? level : level - levels_since_pole + 1;
}

// In grid units.
int64_t WidthIn(int level, int64_t row) {
  return int64_t{1} << (kGridBitsPerTree - level + DoublingsIn(level, row));
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

int64_t Quadcode::ColumnsAround(int level, int64_t row) {
  return int64_t{kTreeColumns} << (level - DoublingsIn(level, row));
}

Quadcode Quadcode::FromColumnRow(int level, int64_t column, int64_t row) {
  BELVEDERE_CHECK(level >= 0 && level <= kMaxLevel);
  const int64_t columns = ColumnsAround(level, row);
  BELVEDERE_CHECK(row >= 0 && row < int64_t{kTreeRows} << level);
  column = ((column % columns) + columns) % columns;
  const int64_t columns_in_tree = columns / kTreeColumns;
  const int64_t rows_in_tree = int64_t{1} << level;
  const auto tree = static_cast<uint64_t>((row / rows_in_tree) * kTreeColumns + column / columns_in_tree);
  const auto x = static_cast<uint64_t>(column % columns_in_tree);
  const auto y = static_cast<uint64_t>(row % rows_in_tree);
  return Quadcode((tree << kTreeShift) | (FirstCode(level) + (Spread(x) | (Spread(y) << 1))));
}

Quadcode Quadcode::Containing(double latitude_deg, double longitude_deg, int level) {
  const double rows_per_degree = std::ldexp(1.0, level) / kTreeDegrees;
  const int64_t row = std::clamp<int64_t>(static_cast<int64_t>(std::floor((latitude_deg + 90.0) * rows_per_degree)), 0,
                                          (int64_t{kTreeRows} << level) - 1);
  const double columns_per_degree = static_cast<double>(ColumnsAround(level, row)) / (kTreeColumns * kTreeDegrees);
  const auto column = static_cast<int64_t>(std::floor((longitude_deg + 180.0) * columns_per_degree));
  return FromColumnRow(level, column, row);
}

std::optional<Quadcode> Quadcode::FromWord(uint64_t word) {
  if ((word & kCodeMask) >= FirstCode(kMaxLevel + 1)) return std::nullopt;
  const Quadcode node(word);
  if (node.column_in_tree() >= ColumnsAround(node.level(), node.row()) / kTreeColumns) return std::nullopt;
  return node;
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

int64_t Quadcode::column_in_tree() const {
  return static_cast<int64_t>(Gather(code() - FirstCode(level())));
}

int64_t Quadcode::column() const {
  return (int64_t{tree() % kTreeColumns} << (level() - Doublings())) + column_in_tree();
}

int64_t Quadcode::row() const {
  const int own = level();
  const auto y = static_cast<int64_t>(Gather((code() - FirstCode(own)) >> 1));
  return (int64_t{tree() / kTreeColumns} << own) + y;
}

std::span<const int> Quadcode::Children() const {
  static constexpr std::array<int, 4> kAll{0, 1, 2, 3};
  static constexpr std::array<int, 3> kOfNorthRoot{0, 1, 2}, kOfSouthRoot{0, 2, 3};
  static constexpr std::array<int, 2> kAtPole{0, 2};
  const bool north = touches_north_pole(), south = touches_south_pole();
  if (!north && !south) return kAll;
  if (!is_root()) return kAtPole;
  return north ? kOfNorthRoot : kOfSouthRoot;
}

int Quadcode::Doublings() const {
  return DoublingsIn(level(), row());
}

bool Quadcode::touches_north_pole() const {
  return row() == (int64_t{kTreeRows} << level()) - 1;
}
bool Quadcode::touches_south_pole() const {
  return row() == 0;
}

GridPoint Quadcode::SouthWest() const {
  const int own = level();
  const int shift = kGridBitsPerTree - own;
  const int64_t row = this->row();
  const auto tree_x = static_cast<uint32_t>(tree() % kTreeColumns) << kGridBitsPerTree;
  return {tree_x + static_cast<uint32_t>(column_in_tree() << (shift + DoublingsIn(own, row))),
          static_cast<uint32_t>(row << shift)};
}

double Quadcode::HeightDegrees() const {
  return std::ldexp(kTreeDegrees, -level());
}
double Quadcode::WidthDegrees() const {
  return std::ldexp(kTreeDegrees, Doublings() - level());
}

GeoBox Quadcode::Box() const {
  const double width = WidthDegrees(), height = HeightDegrees();
  const double west = static_cast<double>(column()) * width - 180.0;
  const double south = static_cast<double>(row()) * height - 90.0;
  return {west, south, west + width, south + height};
}

std::vector<Quadcode> Quadcode::Around() const {
  const int own = level();
  const int64_t west = SouthWest().x, east = west + GridWidth();
  const int64_t last_row = (int64_t{kTreeRows} << own) - 1;
  std::vector<Quadcode> around;
  for (int64_t row = std::max<int64_t>(this->row() - 1, 0); row <= std::min(this->row() + 1, last_row); ++row) {
    const int64_t width = WidthIn(own, row);
    const int64_t first = west / width - (west % width == 0 ? 1 : 0);
    for (int64_t column = first; column <= east / width; ++column) around.push_back(FromColumnRow(own, column, row));
  }
  return around;
}

std::optional<Quadcode> Quadcode::BesideParallel(bool north) const {
  const GridPoint corner = SouthWest();
  const uint32_t border = north ? corner.y + GridHeight() : corner.y;
  if (border == 0 || border == kGridNorthPole) return std::nullopt;
  for (int level = 0; level <= kMaxLevel; ++level) {
    const int shift = kGridBitsPerTree - level;
    if ((border & ((uint32_t{1} << shift) - 1)) != 0) continue;  // there the border lies within a quadnode
    const int64_t row = int64_t{border >> shift} - (north ? 0 : 1);
    const int64_t width = WidthIn(level, row);
    if (width <= int64_t{GridWidth()}) return FromColumnRow(level, corner.x / width, row);
  }
  return std::nullopt;  // none is so fine: beyond kMaxLevel
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
    const std::span<const int> children = node.Children();
    if (std::find(children.begin(), children.end(), digit - '0') == children.end()) return std::nullopt;
    node = node.Child(digit - '0');
  }
  return node;
}

}  // namespace belvedere
