#include "runtime/scene/entity.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

namespace belvedere {

std::string EntityId::ToString() const {
  return fmt::format("{}:{}:{}", site, application, entity);
}

std::optional<EntityId> EntityId::Parse(std::string_view text) {
  std::array<uint16_t, 3> numbers{};
  const char* at = text.data();
  const char* const end = at + text.size();
  for (size_t i = 0; i < numbers.size(); ++i) {
    if (i > 0 && (at == end || *at++ != ':')) return std::nullopt;
    const auto [after, error] = std::from_chars(at, end, numbers[i]);
    if (error != std::errc() || after == at) return std::nullopt;
    at = after;
  }
  if (at != end) return std::nullopt;
  return EntityId{numbers[0], numbers[1], numbers[2]};
}

std::string EntityType::ToString() const {
  return fmt::format("{}.{}.{}.{}.{}.{}.{}", kind, domain, country, category, subcategory, specific, extra);
}

Marking Marking::Sanitise(std::span<const uint8_t> bytes) {
  Marking marking;
  for (const uint8_t byte : bytes.first(std::min(bytes.size(), kMaxLength))) {
    if (byte == 0) break;
    marking.text_[marking.length_++] = byte >= 0x20 && byte < 0x7F ? static_cast<char>(byte) : '?';
  }
  while (marking.length_ > 0 && marking.text_[marking.length_ - size_t{1}] == ' ') --marking.length_;
  return marking;
}

Marking Marking::Sanitise(std::string_view text) {
  std::array<uint8_t, kMaxLength> bytes{};
  const size_t length = std::min(text.size(), kMaxLength);
  std::copy_n(text.begin(), length, bytes.begin());
  return Sanitise(std::span<const uint8_t>(bytes.data(), length));
}

std::optional<EntityPattern> EntityPattern::Parse(std::string_view text) {
  EntityPattern pattern;
  for (size_t i = 0; !text.empty(); ++i) {
    if (i == kNumbers) return std::nullopt;
    const size_t dot = text.find('.');
    const std::string_view part = text.substr(0, dot);
    if (part != "*") {
      uint16_t number = 0;
      const auto parsed = std::from_chars(part.data(), part.data() + part.size(), number);
      if (parsed.ec != std::errc() || parsed.ptr != part.data() + part.size()) return std::nullopt;
      pattern.numbers_[i] = number;
    }
    if (dot == std::string_view::npos) break;
    text.remove_prefix(dot + 1);
    if (text.empty()) return std::nullopt;
  }
  return pattern;
}

bool EntityPattern::Fits(const EntityType& type) const {
  const std::array<uint16_t, kNumbers> own{type.kind,        type.domain,   type.country, type.category,
                                           type.subcategory, type.specific, type.extra};
  for (size_t i = 0; i < kNumbers; ++i) {
    if (numbers_[i] && *numbers_[i] != own[i]) return false;
  }
  return true;
}

}  // namespace belvedere
