// Quadcode frame: a transparent image of the quadnode's border, as a thin line, and its name in the middle: which pages
// the ground is drawn from can be seen at a glance.
//
// Threads: pure.
#pragma once

#include "runtime/earth/quadcode.h"
#include "servers/page_text.h"

#include <memory>

namespace belvedere {

// RGBA; all mip levels are filled.
std::unique_ptr<ImagePage> DrawQuadcodeFrame(Quadcode node, const PageText& text);

}  // namespace belvedere
