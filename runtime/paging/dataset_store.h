// What Dataset and DatasetWriter agree on: keys and metadata of the LMDB store. docs/dataset-format.md has the layout.
//
// Key of a page: layer number in one byte, then the quadcode word, both big-endian, so that a layer is a range of keys
// in quadcode order. What the builder keeps of a page for itself has the page's key and one byte more. Key of the
// metadata: the bytes "meta", which no page key equals in length.
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
// A file of features is named by these and an id between them.
inline constexpr std::string_view kFeaturesPrefix = "features-", kFeaturesSuffix = ".sqlite";
// Of a store that is not finished: what it is being made of, and what its builder noted.
inline constexpr std::string_view kMadeOfKey = "made of";
inline constexpr std::string_view kNotesKey = "notes";

// Of a store that is laid over others: 1 lies on kStoreFile, each other on the one before.
inline std::string ChangeFile(int number) {
  return "change-" + std::to_string(number) + ".mdb";
}

using Key = std::array<uint8_t, kKeyBytes>;
using DeviationsKey = std::array<uint8_t, kKeyBytes + 1>;

inline Key MakeKey(int layer, uint64_t word) {
  Key key{static_cast<uint8_t>(layer)};
  for (size_t i = 0; i < 8; ++i) key[1 + i] = static_cast<uint8_t>(word >> (56 - 8 * i));
  return key;
}
inline DeviationsKey MakeDeviationsKey(int layer, uint64_t word) {
  DeviationsKey key{};
  const Key page = MakeKey(layer, word);
  for (size_t i = 0; i < kKeyBytes; ++i) key[i] = page[i];
  key[kKeyBytes] = 'd';
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
  std::string id{};    // of this store: no other has it; empty where it was made before stores had one
  std::string over{};  // of a change: id of the store under it
  // The file beside the store with the features of its vector layers; empty where it has none.
  std::string features{};
  int version = kDatasetVersion;  // as it was read; what is written is of kDatasetVersion
};

// An object, and back. FromJson throws where it is damaged.
std::string PropertyToJson(const PropertyRecord& property);
PropertyRecord PropertyFromJson(std::string_view text);

std::string ToJson(const Metadata& metadata);
// The reason alone; refuses another version by its number.
Result<Metadata> FromJson(std::string_view text);

}  // namespace belvedere::store
