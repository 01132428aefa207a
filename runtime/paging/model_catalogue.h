// ModelCatalogue: which model shows which kind of entity. A table of numbers, so that managers and the object server
// agree on what a model page's key means without either knowing the other.
//
// Threads: read-only after it was made.
#pragma once

#include "runtime/earth/quadcode.h"

#include <string>
#include <utility>
#include <vector>

namespace belvedere {

struct ModelEntry {
  std::string name;  // file name without its ending: "airliner" is read from airliner.gltf
  float length_m =
      10;  // of the real thing, nose to tail: scales the model and says how large it is before it is loaded
};

class ModelCatalogue {
 public:
  ModelCatalogue() = default;
  ModelCatalogue(std::string folder, std::vector<ModelEntry> entries)
      : folder_(std::move(folder)), entries_(std::move(entries)) {}

  const std::string& folder() const { return folder_; }
  const std::vector<ModelEntry>& entries() const { return entries_; }
  // Index of the entry of that name, -1 where there is none.
  int Find(const std::string& name) const {
    for (size_t i = 0; i < entries_.size(); ++i) {
      if (entries_[i].name == name) return static_cast<int>(i);
    }
    return -1;
  }

  // The key word of model `number` (see paging.h), and back.
  static Quadcode ModelNode(int number) { return Quadcode::FromColumnRow(kMaxLevel, number, kModelRow); }
  static bool IsModelNode(Quadcode node) { return node.level() == kMaxLevel && node.row() == kModelRow; }
  static int ModelNumber(Quadcode node) { return static_cast<int>(node.column()); }

 private:
  static constexpr int64_t kModelRow = int64_t{kTreeRows / 2} << kMaxLevel;  // at the equator, where a row is longest

  std::string folder_;
  std::vector<ModelEntry> entries_;
};

}  // namespace belvedere
