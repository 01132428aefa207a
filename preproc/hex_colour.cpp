#include "preproc/hex_colour.h"

#include <charconv>
#include <cstddef>

namespace belvedere {

std::optional<std::array<uint8_t, 4>> ParseHexColour(std::string_view text) {
  if ((text.size() != 4 && text.size() != 7 && text.size() != 9) || text[0] != '#') return std::nullopt;
  const size_t digits = text.size() == 4 ? 1 : 2;
  std::array<uint8_t, 4> colour{0, 0, 0, 255};
  for (size_t i = 0; i < (text.size() - 1) / digits; ++i) {
    const char* const first = text.data() + 1 + digits * i;
    const auto [end, problem] = std::from_chars(first, first + digits, colour[i], 16);
    if (problem != std::errc() || end != first + digits) return std::nullopt;
    if (digits == 1) colour[i] = static_cast<uint8_t>(colour[i] * 17);
  }
  return colour;
}

}  // namespace belvedere
