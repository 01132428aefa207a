#include "preproc/vectors/feature.h"

#include <algorithm>
#include <cmath>

namespace belvedere {

GridPlace GridPlace::At(double latitude_deg, double longitude_deg) {
  return {std::llround((longitude_deg + 180) * kUnitsPerDegree), std::llround((latitude_deg + 90) * kUnitsPerDegree)};
}

void GridExtent::Add(const FeatureParts& parts) {
  for (const FeaturePart& part : parts) {
    for (const GridPlace& place : part) {
      west = std::min(west, place.x);
      east = std::max(east, place.x);
      south = std::min(south, place.y);
      north = std::max(north, place.y);
    }
  }
}

int64_t GridExtent::size() const {
  return std::max(east - west, north - south);
}

GridPlace GridExtent::middle() const {
  return {west + (east - west) / 2, south + (north - south) / 2};
}

GeoBox GridExtent::box() const {
  const GridPlace low{west, south}, high{east, north};
  return {low.longitude_deg(), low.latitude_deg(), high.longitude_deg(), high.latitude_deg()};
}

}  // namespace belvedere
