// Markup: small pieces of HTML and SVG that the report is put together from.
//
// Threads: pure functions.
#pragma once

#include "preproc/height_histogram.h"
#include "preproc/picture.h"
#include "runtime/paging/dataset.h"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace belvedere::markup {

// Text as text, within elements and quoted attributes, whatever it holds.
std::string Escape(std::string_view text);

std::string Bytes(int64_t count);       // "12.3 MB"
std::string Count(int64_t count);       // "12,345"
std::string Seconds(double seconds);    // "1 h 02 min", "2 min 03 s", "4.5 s"
std::string Distance(double degrees);   // on the ground north to south: "1.2 km", "38 m"
std::string Latitude(double degrees);   // "38.6269 N"
std::string Longitude(double degrees);  // "117.305 W", turned to within 180
std::string Css(const Rgb& colour);     // "#440154"

// Rows of a table that are shown, and a line that says how many are not.
inline constexpr size_t kMostRows = 300;
std::string More(size_t rows, std::string_view what);

// A table's head, from plain words.
std::string Head(std::span<const std::string_view> columns);
// An extent as "120.756 W to 117.305 W, 36.634 N to 38.6269 N".
std::string Extent(const GeoBox& box);

// The colour in which source number i is drawn.
Rgb SourceColour(size_t i);
// A map of the Earth with the outlines of the sources over the picture, numbered from 1.
std::string Map(const std::string& picture_uri, std::span<const SourceRecord> sources);
// The bars, with the heights at which they begin and end.
std::string Bars(const HeightHistogram& histogram);

}  // namespace belvedere::markup
