// Hex colours: "#rgb", "#rrggbb" and "#rrggbbaa", as the web writes them.
//
// Threads: pure functions.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace belvedere {

// sRGB and alpha, which is 255 where the text says none. Nothing where it is no such colour.
std::optional<std::array<uint8_t, 4>> ParseHexColour(std::string_view text);

}  // namespace belvedere
