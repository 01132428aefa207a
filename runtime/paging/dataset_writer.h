// DatasetWriter: makes a dataset's store, in batches of pages, each batch one transaction.
//
// The store is written to PATH.partial and moved over PATH by Finish, so a build that fails or is killed leaves what
// was at PATH before. A store that was left unfinished is overwritten by the next build.
//
// Threads: one at a time.
#pragma once

#include "runtime/base/status.h"
#include "runtime/paging/dataset.h"

#include <memory>
#include <string>
#include <vector>

namespace belvedere {

class DatasetWriter {
 public:
  static Result<std::unique_ptr<DatasetWriter>> Create(const std::string& path);
  virtual ~DatasetWriter() = default;  // unless finished, removes the partial store

  // value: an encoded page (page_codec.h). A page put twice keeps the last value.
  virtual Status Put(int layer, Quadcode node, const std::vector<uint8_t>& value) = 0;
  // Makes what was put so far durable in the partial store, and readable by Get.
  virtual Status Commit() = 0;
  // A page put before; nullopt when there is none.
  virtual std::optional<std::vector<uint8_t>> Get(int layer, Quadcode node) = 0;
  // Writes the metadata (page counts and bytes are filled in here), syncs, and moves the store into place.
  virtual Status Finish(std::vector<LayerRecord> layers, const std::string& build_time) = 0;
};

}  // namespace belvedere
