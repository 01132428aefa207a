#include "preproc/colour_match.h"

#include "preproc/colour_fit.h"
#include "preproc/composite.h"
#include "preproc/lattice.h"

#include <algorithm>
#include <cmath>

namespace belvedere {
namespace {

constexpr int kMostSamples = 64;  // a side
constexpr double kSamplesAPixel = 2;

bool Contains(const GeoBox& outer, const GeoBox& inner) {
  return outer.south_deg <= inner.south_deg && outer.north_deg >= inner.north_deg &&
         Covers(outer, inner.west_deg, inner.south_deg) && Covers(outer, inner.east_deg, inner.north_deg) &&
         outer.east_deg - outer.west_deg >= inner.east_deg - inner.west_deg;
}

// The coarsest pixels of a source and of those below it, down to one that lies under all of it.
double SpacingOf(const std::vector<RasterSource*>& sources, size_t place) {
  const GeoBox& box = sources[place]->georeference().extent();
  double spacing_deg = sources[place]->georeference().spacing_deg();
  for (size_t below = place; below-- > 0;) {
    const Georeference& georeference = sources[below]->georeference();
    if (!Overlap(georeference.extent(), box)) continue;
    spacing_deg = std::max(spacing_deg, georeference.spacing_deg());
    if (Contains(georeference.extent(), box)) break;
  }
  return spacing_deg;
}

// Positions all over a box, in the middle of as many equal parts.
LatticeRows SampleLattice(const GeoBox& box, double spacing_deg) {
  const auto parts = [&](double size_deg) {
    return std::clamp(static_cast<int>(std::lround(kSamplesAPixel * size_deg / spacing_deg)), 1, kMostSamples);
  };
  const double south = std::max(box.south_deg, -90.0), north = std::min(box.north_deg, 90.0);
  const int columns = parts(box.east_deg - box.west_deg), rows = parts(north - south);
  LatticeRows lattice;
  for (int i = 0; i < columns; ++i) {
    const double longitude = box.west_deg + (box.east_deg - box.west_deg) * (i + 0.5) / columns;
    lattice.longitudes_deg.push_back(longitude - 360 * std::floor((longitude + 180) / 360));
  }
  for (int j = 0; j < rows; ++j) {
    lattice.latitudes_deg.push_back(south + (north - south) * (j + 0.5) / rows);
    lattice.rows.push_back(j);
  }
  return lattice;
}

}  // namespace

std::vector<Unmatched> MatchColours(const std::vector<RasterSource*>& sources, const Geoid& geoid) {
  std::vector<Unmatched> unmatched;
  const bool any = std::any_of(sources.begin(), sources.end(), [](const auto* s) { return s->spec().match_colour; });
  if (!any) return unmatched;
  Composite composite(LayerKind::kImagery, sources, geoid);
  for (size_t place = 0; place < sources.size(); ++place) {
    if (!sources[place]->spec().match_colour) continue;
    const double spacing_deg = SpacingOf(sources, place);
    const LatticeRows lattice = SampleLattice(sources[place]->georeference().extent(), spacing_deg);
    const std::vector<ColourPair> pairs = composite.ColourPairs(place, lattice, {spacing_deg, spacing_deg});
    if (pairs.size() >= size_t{kLeastPairs}) {
      sources[place]->SetColourFit(FitColours(pairs));
      continue;
    }
    unmatched.push_back(
        {sources[place],
         fmt::format("its colours are left as they are: at {} of {} positions it and what lies below it have colours, "
                     "and match_colour needs {}",
                     pairs.size(), lattice.longitudes_deg.size() * lattice.latitudes_deg.size(), kLeastPairs)});
  }
  return unmatched;
}

}  // namespace belvedere
