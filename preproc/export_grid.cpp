#include "preproc/export_grid.h"

#include "preproc/georeference.h"
#include "runtime/paging/page.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace belvedere {
namespace {

// An extent that lies on the grid but for rounding is not widened.
constexpr double kSlack_cells = 1e-6;

// With west in [-180, 180) and east over it.
Result<GeoBox> Straightened(GeoBox box) {
  const bool finite = std::isfinite(box.west_deg + box.south_deg + box.east_deg + box.north_deg);
  if (!finite || std::abs(box.west_deg) > 360 || std::abs(box.east_deg) > 720 || box.east_deg - box.west_deg > 360 ||
      box.south_deg < -90 || box.north_deg > 90) {
    return Status::Error("the extent {} {} {} {} is not on the Earth; give west, south, east, north in degrees",
                         box.west_deg, box.south_deg, box.east_deg, box.north_deg);
  }
  if (box.south_deg >= box.north_deg || box.west_deg == box.east_deg)
    return Status::Error("the extent is empty; give west, south, east, north in degrees");
  if (box.east_deg < box.west_deg) box.east_deg += 360;
  const double turn_deg = 360 * std::floor((box.west_deg + 180) / 360);
  return GeoBox{box.west_deg - turn_deg, box.south_deg, box.east_deg - turn_deg, box.north_deg};
}

int FinestLevelIn(const Dataset& dataset, int layer, const GeoBox& box) {
  int finest = 0;
  for (const uint64_t word : dataset.Nodes(layer)) {
    const Quadcode node = *Quadcode::FromWord(word);
    if (node.level() > finest && Overlap(box, node.Box())) finest = node.level();
  }
  return finest;
}

// The smallest box that holds all quadnodes of the level; it may go over 180 E.
GeoBox BoxOfLevel(const Dataset& dataset, int layer, int level) {
  // From west to east, in columns as wide as quadnodes are far from the poles.
  std::vector<std::pair<int64_t, int64_t>> spans;
  int64_t south = std::numeric_limits<int64_t>::max(), north = 0;
  for (const uint64_t word : dataset.Nodes(layer)) {
    const Quadcode node = *Quadcode::FromWord(word);
    if (node.level() != level) continue;
    const int doublings = node.Doublings();
    spans.emplace_back(node.column() << doublings, (node.column() + 1) << doublings);
    south = std::min(south, node.row());
    north = std::max(north, node.row() + 1);
  }
  std::sort(spans.begin(), spans.end());
  // What lies outside is the widest gap between spans that follow each other round the Earth.
  const int64_t around = int64_t{kTreeColumns} << level;
  int64_t west = spans.front().first, end = spans.front().second;
  int64_t widest = 0, east = 0;
  for (const auto& [from, to] : spans) {
    if (from - end > widest) {
      widest = from - end;
      west = from;
      east = end + around;
    }
    end = std::max(end, to);
  }
  if (spans.front().first + around - end >= widest) {
    west = spans.front().first;
    east = end;
  }
  const double size_deg = std::ldexp(kTreeDegrees, -level);
  return {static_cast<double>(west) * size_deg - 180, static_cast<double>(south) * size_deg - 90,
          static_cast<double>(east) * size_deg - 180, static_cast<double>(north) * size_deg - 90};
}

// Whole cells from first to last.
struct CellRange {
  int64_t first = 0, last = 0;
};
CellRange CellsOf(double from_deg, double to_deg, double spacing_deg) {
  return {static_cast<int64_t>(std::floor(from_deg / spacing_deg + kSlack_cells)),
          static_cast<int64_t>(std::ceil(to_deg / spacing_deg - kSlack_cells))};
}

}  // namespace

int ExportGrid::CellsPerNode() const {
  return kind == LayerKind::kElevation ? kCells : kImageInner;
}

double ExportGrid::SpacingDegrees() const {
  return std::ldexp(kTreeDegrees / CellsPerNode(), -level);
}

std::array<double, 6> ExportGrid::GeoTransform() const {
  const double half = kind == LayerKind::kElevation ? SpacingDegrees() / 2 : 0;
  const GeoBox box = Box();
  return {box.west_deg - half, SpacingDegrees(), 0, box.north_deg + half, 0, -SpacingDegrees()};
}

GeoBox ExportGrid::Box() const {
  const int cells = kind == LayerKind::kElevation ? 1 : 0;  // one less than there are posts
  const auto degrees = [&](int64_t count) { return static_cast<double>(count) * SpacingDegrees(); };
  return {degrees(first_column) - 180, degrees(first_row) - 90, degrees(first_column + width - cells) - 180,
          degrees(first_row + height - cells) - 90};
}

Result<ExportGrid> PlanExport(const Dataset& dataset, int layer, std::optional<GeoBox> extent,
                              std::optional<int> level) {
  const LayerRecord& record = dataset.layers()[static_cast<size_t>(layer)];
  if (extent) {
    auto straight = Straightened(*extent);
    if (!straight.ok()) return straight.status();
    extent = *straight;
  }
  const int finest = extent ? FinestLevelIn(dataset, layer, *extent) : record.max_level;
  if (level.value_or(finest) > finest || level.value_or(finest) < 0) {
    return Status::Error("layer {} has no page of level {}{}; give a level from 0 to {}", record.name, *level,
                         extent ? " in that extent" : "", finest);
  }
  ExportGrid grid{.kind = record.kind, .level = level.value_or(finest)};
  const GeoBox box = extent ? *extent : BoxOfLevel(dataset, layer, grid.level);
  const CellRange columns = CellsOf(box.west_deg + 180, box.east_deg + 180, grid.SpacingDegrees());
  const CellRange rows = CellsOf(box.south_deg + 90, box.north_deg + 90, grid.SpacingDegrees());
  const int64_t posts = record.kind == LayerKind::kElevation ? 1 : 0;  // one more than there are cells
  const int64_t around = (int64_t{kTreeColumns} << grid.level) * grid.CellsPerNode();
  const int64_t width = std::min(columns.last - columns.first + posts, around);
  const int64_t height = rows.last - rows.first + posts;
  if (std::max(width, height) > std::numeric_limits<int>::max()) {
    return Status::Error("{} x {} pixels are more than a raster can have; give a smaller extent or a coarser level",
                         width, height);
  }
  grid.first_column = columns.first;
  grid.first_row = rows.first;
  grid.width = static_cast<int>(width);
  grid.height = static_cast<int>(height);
  return grid;
}

}  // namespace belvedere
