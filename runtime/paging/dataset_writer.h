// DatasetWriter: makes a dataset's store, in batches of pages, each batch one transaction.
//
// The store is written to PATH.partial and moved into PATH by Finish, over the store and the changes that were there,
// so a build that fails or is killed leaves what was at PATH before. What a writer that was killed had committed is
// taken up by the next that makes a dataset of the same; any other throws it away. No two writers are at work on one
// path at a time.
//
// Threads: Get, any; all else one at a time.
#pragma once

#include "runtime/base/status.h"
#include "runtime/paging/dataset.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace belvedere {

// An id that no other store has.
std::string NewStoreId();

class DatasetWriter {
 public:
  // made_of: all that the pages depend on, as text. Where it is empty, or not that of what an earlier writer left, the
  // store starts empty.
  static Result<std::unique_ptr<DatasetWriter>> Create(const std::string& path, const std::string& made_of = {});
  // What a writer has left that makes a dataset of the same. Fails where there is nothing, or it is of something else,
  // which stays as it is.
  static Result<std::unique_ptr<DatasetWriter>> TakeUp(const std::string& path, const std::string& made_of);
  // Throws away what a writer that was killed has left, if no other is at work there.
  static Status Discard(const std::string& path);
  virtual ~DatasetWriter() = default;  // unless finished or left, removes the partial store

  // value: an encoded page (page_codec.h). A page put twice keeps the last value.
  virtual Status Put(int layer, Quadcode node, const std::vector<uint8_t>& value) = 0;
  // What the builder keeps for itself of a page; readers pass it over.
  virtual Status PutDeviations(int layer, Quadcode node, const std::vector<uint8_t>& value) = 0;
  // Text that is kept with the next Commit, for the writer that goes on if this one is killed.
  virtual Status Note(const std::string& text) = 0;
  // Makes what was put so far durable in the partial store. Whenever the system stops, what was committed last is
  // there, or what was before it.
  virtual Status Commit() = 0;

  // Commits, and leaves all that is there, now and when the writer goes, for whoever goes on from it.
  virtual Status Leave() = 0;

  // What was put before, also by the writer that this one goes on from; nullopt when there is none.
  virtual std::optional<std::vector<uint8_t>> Get(int layer, Quadcode node) = 0;
  virtual std::optional<std::vector<uint8_t>> GetDeviations(int layer, Quadcode node) = 0;
  // Quadcode words of the pages of a layer that an earlier writer had committed, ascending; and what it noted.
  virtual std::vector<uint64_t> Resumed(int layer) = 0;
  virtual const std::string& notes() const = 0;

  // The folder where Finish looks for a file that is to lie beside the store.
  virtual std::string partial_folder() const = 0;
  // The name of a file in partial_folder, or in the dataset's folder, that has the features of vector layers. Finish
  // moves it into place with the store, and removes those of stores before.
  virtual void SetFeatures(const std::string& file) = 0;

  // Writes the metadata (page counts and bytes are filled in here), syncs, and moves the store into place.
  virtual Status Finish(std::vector<LayerRecord> layers, const std::string& build_time) = 0;
};

}  // namespace belvedere
