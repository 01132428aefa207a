// Big-endian values in a span of bytes, as DIS, IP and UDP write them.
//
// A reader and a writer take the same calls, so that one list of a PDU's fields serves both (pdu_layout.h):
//   wire(a, b, c)      the values one after the other: numbers, vectors, ids, types, arrays of bytes, clocks
//   wire.Skip(n)       n bytes of padding; written as zeros
//   wire.Size<U>(raw, unit)  the size of `raw` in units of so many bytes, as an integer of type U
//   wire.Content(raw)  the bytes themselves
// What a reader cannot take because the bytes end reads as zeros, and fits() is false from then on; a writer that has
// no room likewise.
//
// Threads: each cursor belongs to its user.
#pragma once

#include "runtime/scene/object_table.h"

#include <array>
#include <bit>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <glm/vec3.hpp>
#include <span>

namespace belvedere::dis {

// Bytes of a PDU that are not taken apart; they lie in the datagram.
class RawBytes {
 public:
  RawBytes() = default;
  explicit RawBytes(std::span<const uint8_t> bytes) : data_(bytes.data()), size_(bytes.size()) {}
  size_t size() const { return size_; }
  std::span<const uint8_t> bytes() const {
    return data_ == nullptr ? std::span<const uint8_t>() : std::span(data_, size_);
  }

 private:
  friend class WireReader;
  const uint8_t* data_ = nullptr;
  size_t size_ = 0;  // may be announced before the data come
};

template <typename T>
concept WireNumber = std::integral<T> || std::floating_point<T>;

// The unsigned integer of that many bytes.
template <size_t kBytes>
using WireUnsigned =
    std::conditional_t<kBytes == 1, uint8_t,
                       std::conditional_t<kBytes == 2, uint16_t, std::conditional_t<kBytes == 4, uint32_t, uint64_t>>>;

template <std::unsigned_integral U>
constexpr U FromBigEndian(U value) {
  if constexpr (std::endian::native == std::endian::big || sizeof(U) == 1) return value;
  if constexpr (sizeof(U) == 2) return static_cast<U>(__builtin_bswap16(value));
  if constexpr (sizeof(U) == 4) return static_cast<U>(__builtin_bswap32(value));
  if constexpr (sizeof(U) == 8) return static_cast<U>(__builtin_bswap64(value));
}

class WireReader {
 public:
  template <typename T>
  using Field = T;  // what a layout lists: values to fill

  explicit WireReader(std::span<const uint8_t> bytes, size_t offset = 0) : bytes_(bytes), at_(offset) {}

  template <typename... Ts>
  void operator()(Ts&... values) {
    (Read(values), ...);
  }
  template <WireNumber T>
  T Next() {
    T value{};
    Read(value);
    return value;
  }
  void Skip(size_t count) { Take(count); }
  template <std::unsigned_integral U>
  void Size(RawBytes& raw, size_t unit = 1) {
    raw.size_ = unit * Next<U>();
  }
  void Content(RawBytes& raw) { Content(raw, raw.size_); }
  void Content(RawBytes& raw, size_t size) {
    raw.data_ = Take(size);
    raw.size_ = raw.data_ == nullptr ? 0 : size;
  }
  // All that is left.
  void Rest(RawBytes& raw) { Content(raw, bytes_.size() - at_); }
  bool fits() const { return fits_; }
  size_t at() const { return at_; }
  std::span<const uint8_t> Bytes(size_t count) {
    const uint8_t* first = Take(count);
    return first == nullptr ? std::span<const uint8_t>() : std::span(first, count);
  }

 private:
  // The next `count` bytes, or nullptr where there are not so many.
  const uint8_t* Take(size_t count) {
    if (count > bytes_.size() - at_) {
      fits_ = false;
      return nullptr;
    }
    at_ += count;
    return bytes_.data() + (at_ - count);
  }
  template <WireNumber T>
  void Read(T& value) {
    WireUnsigned<sizeof(T)> bits = 0;
    if (const uint8_t* bytes = Take(sizeof(T))) std::memcpy(&bits, bytes, sizeof(T));
    value = std::bit_cast<T>(FromBigEndian(bits));
  }
  template <size_t kCount>
  void Read(std::array<uint8_t, kCount>& bytes) {
    if (const uint8_t* from = Take(kCount)) std::memcpy(bytes.data(), from, kCount);
  }
  template <typename T>
  void Read(glm::vec<3, T>& v) {
    (*this)(v.x, v.y, v.z);
  }
  void Read(EntityId& id) { (*this)(id.site, id.application, id.entity); }
  void Read(EntityType& t) { (*this)(t.kind, t.domain, t.country, t.category, t.subcategory, t.specific, t.extra); }

  std::span<const uint8_t> bytes_;
  size_t at_;  // <= bytes_.size()
  bool fits_ = true;
};

class WireWriter {
 public:
  template <typename T>
  using Field = const T;

  explicit WireWriter(std::span<uint8_t> bytes) : bytes_(bytes) {}

  template <typename... Ts>
  void operator()(const Ts&... values) {
    (Write(values), ...);
  }
  void Skip(size_t count) {
    if (uint8_t* to = Room(count)) std::memset(to, 0, count);
  }
  template <std::unsigned_integral U>
  void Size(const RawBytes& raw, size_t unit = 1) {
    Write(static_cast<U>(raw.size() / unit));
  }
  void Content(const RawBytes& raw) { Bytes(raw.bytes()); }
  void Content(const RawBytes& raw, size_t /*size*/) { Content(raw); }
  void Rest(const RawBytes& raw) { Content(raw); }
  void Bytes(std::span<const uint8_t> bytes) {
    if (bytes.empty()) return;
    if (uint8_t* to = Room(bytes.size())) std::memcpy(to, bytes.data(), bytes.size());
  }
  bool fits() const { return fits_; }
  size_t at() const { return at_; }

 private:
  uint8_t* Room(size_t count) {
    if (count > bytes_.size() - at_) {
      fits_ = false;
      return nullptr;
    }
    at_ += count;
    return bytes_.data() + (at_ - count);
  }
  template <WireNumber T>
  void Write(const T& value) {
    const auto bits = FromBigEndian(std::bit_cast<WireUnsigned<sizeof(T)>>(value));
    if (uint8_t* to = Room(sizeof(T))) std::memcpy(to, &bits, sizeof(T));
  }
  template <size_t kCount>
  void Write(const std::array<uint8_t, kCount>& bytes) {
    Bytes(bytes);
  }
  template <typename T>
  void Write(const glm::vec<3, T>& v) {
    (*this)(v.x, v.y, v.z);
  }
  void Write(const EntityId& id) { (*this)(id.site, id.application, id.entity); }
  void Write(const EntityType& t) {
    (*this)(t.kind, t.domain, t.country, t.category, t.subcategory, t.specific, t.extra);
  }

  std::span<uint8_t> bytes_;
  size_t at_ = 0;
  bool fits_ = true;
};

}  // namespace belvedere::dis
