// Buildings: models made of footprints (BuildingPage).
//
// Heights come from the attributes that OpenStreetMap has for them: height, building:levels (3 m each), min_height,
// roof:height; a building of which nothing is known is 6 m high. Lengths are metres unless they say ft or '. Roofs are
// of roof:shape (roof.h), colours of building:colour and roof:colour.
//
// Three levels of detail: walls and roof as they are; without the roof's shape; and the smallest box around each.
//
// Threads: pure functions.
#pragma once

#include "runtime/earth/quadcode.h"
#include "runtime/paging/building_page.h"
#include "runtime/paging/vector_page.h"

#include <array>
#include <memory>
#include <optional>
#include <string_view>

namespace belvedere {

// Of the page's polygons of class building; what else is there is passed over. node: the page's.
std::shared_ptr<BuildingPage> RaiseBuildings(const VectorPage& page, Quadcode node);

// "12", "12.5 m", "40 ft", "40'". Nothing where it is no length.
std::optional<double> ParseLength(std::string_view text);
// As ParseHexColour, without alpha, or one of the common names. Nothing where it is neither.
std::optional<std::array<uint8_t, 3>> ParseColourName(std::string_view text);

}  // namespace belvedere
