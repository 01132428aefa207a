// Entities: what DIS calls them: ids, types, markings, and patterns of types.
//
// Threads: values.
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace belvedere {

struct EntityId {
  uint16_t site = 0, application = 0, entity = 0;
  auto operator<=>(const EntityId&) const = default;
  std::string ToString() const;  // "site:application:entity"
  static std::optional<EntityId> Parse(std::string_view text);
};

// The seven numbers of SISO-REF-010; zero means unspecified.
struct EntityType {
  uint8_t kind = 0, domain = 0;
  uint16_t country = 0;
  uint8_t category = 0, subcategory = 0, specific = 0, extra = 0;
  auto operator<=>(const EntityType&) const = default;
  std::string ToString() const;  // "1.2.225.57.1.1.0"

  static constexpr uint8_t kPlatform = 1, kMunition = 2, kLifeForm = 3;                     // kind
  static constexpr uint8_t kLand = 1, kAir = 2, kSurface = 3, kSubsurface = 4, kSpace = 5;  // of a platform
  bool is_ground_platform() const { return kind == kPlatform && domain == kLand; }
  bool is_air_platform() const { return kind == kPlatform && domain == kAir; }
};

// Up to 11 characters, all printable ASCII.
class Marking {
 public:
  static constexpr size_t kMaxLength = 11;
  Marking() = default;
  // Up to the first NUL; bytes that are not printable ASCII become '?', spaces at the end go.
  static Marking Sanitise(std::span<const uint8_t> bytes);
  static Marking Sanitise(std::string_view text);
  std::string_view view() const { return {text_.data(), length_}; }
  bool empty() const { return length_ == 0; }
  bool operator==(const Marking& other) const { return view() == other.view(); }

 private:
  std::array<char, kMaxLength> text_{};
  uint8_t length_ = 0;
};

// A set of entity types, written as up to seven numbers with dots between, each a number or *; what is left out fits
// anything: "1.2.*.57" is every fixed-wing airliner of every country.
class EntityPattern {
 public:
  // nullopt when it is not seven or fewer numbers and stars.
  static std::optional<EntityPattern> Parse(std::string_view text);
  bool Fits(const EntityType& type) const;

 private:
  static constexpr size_t kNumbers = 7;
  std::array<std::optional<uint16_t>, kNumbers> numbers_{};
};

}  // namespace belvedere

template <>
struct std::hash<belvedere::EntityId> {
  size_t operator()(belvedere::EntityId id) const noexcept {
    const uint64_t word = uint64_t{id.site} << 32 | uint64_t{id.application} << 16 | id.entity;
    const uint64_t mixed = word * 0x9E3779B97F4A7C15u;
    return static_cast<size_t>(mixed ^ (mixed >> 32));
  }
};
