#include "preproc/changed_extents.h"

#include "preproc/georeference.h"
#include "runtime/paging/page.h"

#include <algorithm>

namespace belvedere {
namespace {

bool IsSame(const SourceRecord& a, const SourceRecord& b) {
  if (a.colour_fit.has_value() != b.colour_fit.has_value()) return false;
  if (a.colour_fit && (a.colour_fit->gain != b.colour_fit->gain || a.colour_fit->offset != b.colour_fit->offset))
    return false;
  return IsOfSameFiles(a, b);
}

// Or they share a border, to rounding.
bool Meet(const GeoBox& a, GeoBox b) {
  constexpr double kSliver_deg = 1e-6;
  b.west_deg -= kSliver_deg;
  b.south_deg -= kSliver_deg;
  b.east_deg += kSliver_deg;
  b.north_deg += kSliver_deg;
  return Overlap(a, b);
}

}  // namespace

bool IsOfSameFiles(const SourceRecord& a, const SourceRecord& b) {
  return a.settings == b.settings && a.state == b.state;
}

std::vector<GeoBox> ChangedExtents(std::span<const SourceRecord> before, std::span<const SourceRecord> after,
                                   const std::function<bool(size_t)>& has_voids) {
  const std::span<const SourceRecord> all = after;
  while (!before.empty() && !after.empty() && IsSame(before.back(), after.back())) {
    before = before.first(before.size() - 1);
    after = after.first(after.size() - 1);
  }
  const size_t first_above = after.size();
  while (!before.empty() && !after.empty() && IsSame(before.front(), after.front())) {
    before = before.subspan(1);
    after = after.subspan(1);
  }
  std::vector<GeoBox> extents;
  for (const auto& sources : {before, after}) {
    for (const SourceRecord& source : sources) extents.push_back(source.extent);
  }
  for (size_t place = first_above; place < all.size(); ++place) {
    const GeoBox& extent = all[place].extent;
    const bool meets =
        std::any_of(extents.begin(), extents.end(), [&](const GeoBox& box) { return Meet(extent, box); });
    if (meets && has_voids(place)) extents.push_back(extent);
  }
  return extents;
}

bool Touches(std::span<const GeoBox> extents, LayerKind kind, Quadcode node) {
  // One more than the page holds of its neighbours.
  const double margin =
      kind == LayerKind::kElevation ? double{kApron + 1} / kCells : double{kImageGutter + 1} / kImageInner;
  const double margin_deg = margin * node.HeightDegrees(), east_margin_deg = margin * node.WidthDegrees();
  GeoBox box = node.Box();
  box.west_deg -= east_margin_deg;
  box.south_deg -= margin_deg;
  box.east_deg += east_margin_deg;
  box.north_deg += margin_deg;
  return std::any_of(extents.begin(), extents.end(), [&](const GeoBox& extent) {
    if (Overlap(extent, box)) return true;
    // Beyond a pole lies what is half a turn away.
    if (box.north_deg > 90 && Overlap(extent, {-180, 90 - margin_deg, 180, 90})) return true;
    return box.south_deg < -90 && Overlap(extent, {-180, -90, 180, -90 + margin_deg});
  });
}

}  // namespace belvedere
