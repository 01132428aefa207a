// ChangeWriter: changes some pages of a dataset, in one step: it makes a store of what differs, beside the dataset, and
// Finish lays it over those that are there (store_stack.h).
//
// Whenever it is killed, or finds the disk full, the dataset is as it was, or wholly as it was to be. Readers that have
// the dataset open go on reading what they opened. Its cost is that of the pages that change, whatever the dataset's
// size; but every so often it takes the changes before it into its own.
//
// REQUIRES: a page is put or removed once, and its deviations are put before it.
//
// Threads: Get and before(), any; all else one at a time.
#pragma once

#include "runtime/paging/dataset_writer.h"

#include <cstdint>
#include <memory>
#include <string>

namespace belvedere {

class ChangeWriter : public DatasetWriter {
 public:
  // Nobody else changes the dataset from here on until the writer is gone.
  static Result<std::unique_ptr<ChangeWriter>> Create(const std::string& path);

  // The dataset as it was.
  virtual const Dataset& before() const = 0;
  virtual Status Remove(int layer, Quadcode node) = 0;
  // Whether the page was put, the same bytes as before or others.
  virtual bool WasPut(int layer, Quadcode node) const = 0;
  // Pages whose bytes are new, and that are gone.
  virtual int64_t written() const = 0;
  virtual int64_t removed() const = 0;
};

}  // namespace belvedere
