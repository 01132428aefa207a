#include "preproc/vectors/feature_selection.h"

#include <array>

namespace belvedere {

const OsmClass& OsmClassOf(FeatureClass of) {
  // https://wiki.openstreetmap.org/wiki/Map_features; tables as in GDAL's osmconf.ini.
  static const std::array<OsmClass, kFeatureClasses> classes = {{
      {},
      {"lines",
       "highway IS NOT NULL",
       "highway",
       {"motorway", "trunk", "primary", "secondary", "tertiary", "motorway_link", "trunk_link", "primary_link",
        "unclassified", "residential", "living_street", "service", "track"}},
      {"lines", "railway IS NOT NULL", "railway", {"rail", "light_rail", "subway", "narrow_gauge", "tram"}},
      {"lines", "waterway IS NOT NULL", "waterway", {"river", "canal", "stream"}},
      {"multipolygons", "natural = 'water' OR landuse = 'reservoir'"},
      {"multipolygons", "boundary = 'administrative'", "admin_level", {"2", "3", "4", "5", "6", "7", "8"}},
      {"lines", "other_tags LIKE '%\"natural\"=>\"coastline\"%'"},
      {"multipolygons", "aeroway = 'aerodrome'"},
      {"points", "place IS NOT NULL", "place", {"city", "town", "suburb", "village", "hamlet", "locality"}},
      {"multipolygons", "building IS NOT NULL"},
  }};
  return classes[static_cast<size_t>(of)];
}

}  // namespace belvedere
