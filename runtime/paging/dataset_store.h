// What Dataset and DatasetWriter agree on: keys and metadata of the LMDB store. docs/dataset-format.md has the layout.
//
// Key of a page: layer number in one byte, then the quadcode word, both big-endian, so that a layer is a range of keys
// in quadcode order. Key of the metadata: the bytes "meta", which no page key equals in length.
//
// Threads: pure functions.
#pragma once

#include "runtime/base/status.h"
#include "runtime/paging/dataset.h"

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace belvedere::store {

inline constexpr size_t kKeyBytes = 9;
inline constexpr std::string_view kMetadataKey = "meta";
inline constexpr std::string_view kStoreFile = "data.mdb";

using Key = std::array<uint8_t, kKeyBytes>;

inline Key MakeKey(int layer, uint64_t word) {
  Key key{static_cast<uint8_t>(layer)};
  for (size_t i = 0; i < 8; ++i) key[1 + i] = static_cast<uint8_t>(word >> (56 - 8 * i));
  return key;
}
inline uint64_t WordOfKey(const uint8_t* key) {
  uint64_t word = 0;
  for (size_t i = 0; i < 8; ++i) word = word << 8 | key[1 + i];
  return word;
}

struct Metadata {
  std::string build_time;
  std::vector<LayerRecord> layers;
};

std::string ToJson(const Metadata& metadata);
// The reason alone; refuses another version by its number.
Result<Metadata> FromJson(std::string_view text);

}  // namespace belvedere::store
