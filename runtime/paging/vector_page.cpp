#include "runtime/paging/vector_page.h"

#include <fmt/format.h>

#include <array>

namespace belvedere {
namespace {

constexpr std::array<std::string_view, kFeatureClasses> kNames = {"other",  "road",  "railway", "river", "water",
                                                                  "border", "coast", "airport", "place", "building"};

}  // namespace

std::string_view FeatureClassName(FeatureClass of) {
  return kNames[static_cast<size_t>(of)];
}

std::optional<FeatureClass> FeatureClassOf(std::string_view name) {
  for (size_t i = 0; i < kNames.size(); ++i) {
    if (kNames[i] == name) return static_cast<FeatureClass>(i);
  }
  return std::nullopt;
}

std::string TextOf(const AttributeValue& value) {
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  if (const auto* number = std::get_if<int64_t>(&value)) return fmt::format("{}", *number);
  return fmt::format("{}", std::get<double>(value));
}

const AttributeValue* VectorPage::Find(const VectorFeature& feature, std::string_view key) const {
  for (uint32_t i = 0; i < feature.attributes; ++i) {
    const AttributeUse& use = attributes[feature.first_attribute + i];
    if (keys[use.key] == key) return &values[use.value];
  }
  return nullptr;
}

size_t VectorPage::bytes() const {
  size_t bytes = sizeof(*this) + features.capacity() * sizeof(VectorFeature) + parts.capacity() * sizeof(Part) +
                 points.capacity() * sizeof(VectorPoint) + attributes.capacity() * sizeof(AttributeUse) +
                 keys.capacity() * sizeof(std::string) + values.capacity() * sizeof(AttributeValue);
  for (const std::string& key : keys) bytes += key.capacity();
  for (const AttributeValue& value : values) {
    if (const auto* text = std::get_if<std::string>(&value)) bytes += text->capacity();
  }
  return bytes;
}

}  // namespace belvedere
