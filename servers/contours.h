// Contours: a transparent image of lines of equal height above mean sea level, brown on land and blue under the sea,
// the coast between them dark. Every fifth line is heavier, and along some of these their height is written.
//
// The interval depends on the quadnode's level only, so that lines go on from page to page; it is made for texels drawn
// at about a pixel each. Lines are a texel or two wide whatever the slope: a texel's distance from a line is its height
// above it over the gradient, texel by texel. Where lines crowd the thin ones fade, then the heavy ones; ground as flat
// as a lake has none, not even when it lies at just such a height.
//
// A few heights are written a page, where a heavy line runs east and west, wholly within the page's inner texels, so
// that no border cuts one. The same page always has the same ones.
//
// Threads: pure.
#pragma once

#include "runtime/earth/geoid.h"
#include "servers/page_text.h"

#include <memory>

namespace belvedere {

// Metres between lines of a level: 1, 2 or 5 times a power of ten.
double ContourInterval(int level);

// RGBA; all mip levels are filled. sea: height of mean sea level; nullptr: that of the ellipsoid.
std::unique_ptr<ImagePage> DrawContours(const ElevationPage& heights, Quadcode node, const Geoid* sea,
                                        const PageText& text);

}  // namespace belvedere
