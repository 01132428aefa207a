// DatasetFollower: brings what has changed of a dataset on disk to a station that runs ("acquisition on the fly").
//
// It looks at the dataset's files. Where a change was laid over them, or a build has replaced them, it opens what is
// there, makes anew the pages that are in use and that the change may reach, beside those that are shown, and then, all
// at once, lets the servers read the new dataset, puts those pages in place of the old ones, and lets go of the others
// that are stale. Display lists go on with the pages that they have pinned; the next ones find the new pages. A dataset
// that cannot be opened, or lacks layers that the station has, is a notice, and the station goes on as it was.
//
// Threads: any for Notices; a thread of its own looks, at a low priority, unless it is told not to.
#pragma once

#include "runtime/base/mutex.h"
#include "runtime/paging/live_dataset.h"
#include "runtime/paging/model_catalogue.h"
#include "runtime/paging/paging.h"
#include "servers/stock_modules.h"

#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace belvedere {

class DatasetFollower {
 public:
  static constexpr double kPause_s = 0.5;  // between looks

  // The rest outlives the follower. looks: whether it has a thread.
  DatasetFollower(Paging& paging, LiveDataset& dataset, const ModelCatalogue& models, const StockOptions& options,
                  const Clock& clock, bool looks = true);
  ~DatasetFollower();
  DatasetFollower(const DatasetFollower&) = delete;
  DatasetFollower& operator=(const DatasetFollower&) = delete;

  // One look; whether the dataset is another one since. The thread's, or the caller's where there is none.
  bool Look();
  std::vector<std::string> Notices() const EXCLUDES_LOCK(mutex_);

 private:
  void Run() EXCLUDES_LOCK(mutex_);
  Status Follow(const std::shared_ptr<const Dataset>& next);
  void SetNotices(std::vector<std::string> notices) EXCLUDES_LOCK(mutex_);

  Paging& paging_;
  LiveDataset& dataset_;
  const ModelCatalogue& models_;
  const StockOptions options_;
  const Clock& clock_;
  std::string state_;  // on disk, of what was last looked at
  mutable Mutex mutex_;
  CondVar changed_;
  std::vector<std::string> notices_ GUARDED_BY(mutex_);
  bool stopping_ GUARDED_BY(mutex_) = false;
  std::thread thread_;  // last: starts when all else is there
};

}  // namespace belvedere
