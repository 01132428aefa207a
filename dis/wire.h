// Big-endian values in a span of bytes, as DIS, IP and UDP write them.
//
// REQUIRES: the caller has checked that the bytes are there; the spans' ends are asserted all the same.
// Threads: each cursor belongs to its user.
#pragma once

#include "runtime/base/status.h"
#include "runtime/scene/object_table.h"

#include <bit>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>

namespace belvedere::dis {

class WireReader {
 public:
  explicit WireReader(std::span<const uint8_t> bytes, size_t offset = 0) : bytes_(bytes), at_(offset) {}

  uint8_t U8() { return Bytes(1)[0]; }
  uint16_t U16() { return static_cast<uint16_t>(Unsigned(2)); }
  uint32_t U32() { return static_cast<uint32_t>(Unsigned(4)); }
  uint64_t U64() { return Unsigned(8); }
  float F32() { return std::bit_cast<float>(U32()); }
  double F64() { return std::bit_cast<double>(U64()); }
  glm::vec3 Vec3() {
    const float x = F32(), y = F32(), z = F32();
    return {x, y, z};
  }
  glm::dvec3 DVec3() {
    const double x = F64(), y = F64(), z = F64();
    return {x, y, z};
  }
  EntityId Id() {
    const uint16_t site = U16(), application = U16(), entity = U16();
    return {site, application, entity};
  }
  EntityType Type() {
    EntityType type;
    type.kind = U8();
    type.domain = U8();
    type.country = U16();
    type.category = U8();
    type.subcategory = U8();
    type.specific = U8();
    type.extra = U8();
    return type;
  }
  std::span<const uint8_t> Bytes(size_t count) {
    BELVEDERE_CHECK(count <= bytes_.size() - at_);
    at_ += count;
    return bytes_.subspan(at_ - count, count);
  }
  void Skip(size_t count) { Bytes(count); }
  size_t at() const { return at_; }

 private:
  uint64_t Unsigned(size_t count) {
    uint64_t value = 0;
    for (const uint8_t byte : Bytes(count)) value = value << 8 | byte;
    return value;
  }
  std::span<const uint8_t> bytes_;
  size_t at_;  // <= bytes_.size()
};

class WireWriter {
 public:
  explicit WireWriter(std::span<uint8_t> bytes) : bytes_(bytes) {}

  void U8(uint8_t value) { Unsigned(value, 1); }
  void U16(uint16_t value) { Unsigned(value, 2); }
  void U32(uint32_t value) { Unsigned(value, 4); }
  void F32(float value) { Unsigned(std::bit_cast<uint32_t>(value), 4); }
  void F64(double value) { Unsigned(std::bit_cast<uint64_t>(value), 8); }
  void Vec3(const glm::vec3& value) {
    for (int i = 0; i < 3; ++i) F32(value[i]);
  }
  void DVec3(const glm::dvec3& value) {
    for (int i = 0; i < 3; ++i) F64(value[i]);
  }
  void Id(const EntityId& id) {
    for (const uint16_t number : {id.site, id.application, id.entity}) U16(number);
  }
  void Type(const EntityType& type) {
    U8(type.kind);
    U8(type.domain);
    U16(type.country);
    for (const uint8_t number : {type.category, type.subcategory, type.specific, type.extra}) U8(number);
  }
  void Bytes(std::span<const uint8_t> bytes) {
    for (const uint8_t byte : bytes) U8(byte);
  }
  void Zeros(size_t count) {
    for (size_t i = 0; i < count; ++i) U8(0);
  }
  size_t at() const { return at_; }

 private:
  void Unsigned(uint64_t value, size_t count) {
    BELVEDERE_CHECK(count <= bytes_.size() - at_);
    for (size_t i = 0; i < count; ++i) bytes_[at_ + i] = static_cast<uint8_t>(value >> (8 * (count - 1 - i)));
    at_ += count;
  }
  std::span<uint8_t> bytes_;
  size_t at_ = 0;
};

}  // namespace belvedere::dis
