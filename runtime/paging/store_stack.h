// StoreStack: a dataset's stores, open for reading: data.mdb, and the changes laid over it, change-1.mdb and so on.
//
// Each store is an LMDB file that is never changed once it is in its place. A change holds the pages that differ from
// those of the stores under it, and an empty value for each that is gone. It names the store that it lies over by its
// id; a file that names another is left over from before and is not looked at. So whoever opens the stack has one state
// of the dataset or the next, whatever is moved into the folder meanwhile.
//
// Threads: all const methods, any.
// Owns: the memory maps, until destruction.
#pragma once

#include "runtime/base/status.h"
#include "runtime/paging/dataset_store.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace belvedere {

class StoreStack {
 public:
  static constexpr int kMostChanges = 8;  // then the next takes them all into itself

  // folder: of the dataset. Fails with one line when a store is missing, damaged, or of another version.
  static Result<std::unique_ptr<StoreStack>> Open(const std::string& folder);
  ~StoreStack();
  StoreStack(const StoreStack&) = delete;
  StoreStack& operator=(const StoreStack&) = delete;

  // Of the newest store, which speaks for the whole dataset.
  const store::Metadata& metadata() const;
  // Of the store that a change by that number (1 or more) would lie over. REQUIRES: number <= changes() + 1
  const std::string& IdUnder(int number) const;
  int changes() const { return static_cast<int>(files_.size()) - 1; }
  int64_t bytes() const;  // of all stores

  // Calls read with what the newest store that has the key has there. False where none has, or it is gone.
  bool Read(std::span<const uint8_t> key, const std::function<void(std::span<const uint8_t>)>& read) const;
  // Quadcode words of a layer's pages that are there, ascending, layer by layer; fails when a store cannot be listed.
  Result<std::vector<std::vector<uint64_t>>> ListPages() const;
  // Keys and values of pages and deviations of one change, empty ones too, in their order.
  void ForEach(int change, const std::function<void(std::span<const uint8_t>, std::span<const uint8_t>)>& visit) const;

 private:
  class File;
  StoreStack();
  Status OpenFiles(const std::string& folder);

  std::vector<std::unique_ptr<File>> files_;  // the lowest first
};

}  // namespace belvedere
