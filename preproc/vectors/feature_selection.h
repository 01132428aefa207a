// FeatureSelection: which features of a vector source a layer takes, what they are, and what is kept of them.
//
// For OpenStreetMap's files a class says it all: the table, the condition and the order of importance are those of its
// tags. Of other files it says what the features are; they have one table as a rule.
//
// Threads: values; pure functions.
#pragma once

#include "runtime/paging/vector_page.h"

#include <map>
#include <string>
#include <vector>

namespace belvedere {

struct FeatureSelection {
  FeatureClass of = FeatureClass::kOther;
  std::string table;       // OGR's layer; empty: the class's, or the only one
  std::string where;       // a condition in OGR's SQL, besides the class's own
  std::string importance;  // a field with numbers; empty: the class's own order, or how large a feature is
  double resolution_m = 1;
  // Attribute in the dataset -> field of the source. None: all fields, by their names.
  std::map<std::string, std::string> fields;
  // The elevation layer whose ground is made to fit its lines, which are so wide (line_correction.h); empty: none.
  std::string corrects;
  double width_m = 0;
};

// What a class means among the tags of OpenStreetMap, as GDAL's driver has them in tables.
struct OsmClass {
  const char* table = "";
  const char* where = "";
  const char* ordered_by = "";       // a tag whose values say how important a feature is
  std::vector<const char*> order{};  // the most important first
};
const OsmClass& OsmClassOf(FeatureClass of);

}  // namespace belvedere
