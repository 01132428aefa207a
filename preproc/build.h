// Build: from a spec to a dataset.
//
// Pages are made depth first, children before their parent, by all workers at once; each page is computed from the
// sources alone, so no page waits for a neighbour. A source that turns out to be unreadable, or that covers nothing, is
// left out and the build starts over without it, so that a dataset never holds half a source.
//
// A build that was killed is gone on with: pages that it had written are taken over where spec, sources, their files'
// sizes and times, and the program are the same. The dataset has the same pages as if nothing had happened.
//
// Threads: blocks the caller; uses `jobs` workers and one writer.
#pragma once

#include "preproc/shards.h"
#include "preproc/spec.h"
#include "runtime/base/clock.h"
#include "runtime/base/status.h"
#include "runtime/paging/dataset.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace belvedere {

struct SourceRemark {
  std::string source;  // its path as the spec wrote it
  std::string reason;
};

struct BuildOptions {
  std::string out;
  int jobs = 0;                             // 0: as many as the machine has cores
  size_t cache_bytes = size_t{384} << 20;   // of source pixels
  int64_t batch_bytes = int64_t{32} << 20;  // of pages, after which a killed build is gone on with from there
  bool fresh = false;                       // throws away what a killed build has left
  bool show_progress = true;
  // Makes this part alone, as a shard beside the dataset (shards.h).
  std::optional<Shard> shard{};
  // More than 0: takes the pages of so many shards over, and makes the rest.
  int merge = 0;
  bool wait_for_shards = false;  // that others are still at
};

struct BuildReport {
  double seconds = 0;
  double opening_s = 0, pages_s = 0, finishing_s = 0;  // of it; the first two of all rounds
  int rounds = 0;  // more than one where pages were made with sources that then had to be left out
  int jobs = 0;
  int64_t pages = 0;
  int64_t resumed = 0;           // pages of them that were taken over from a build that was interrupted
  std::optional<Shard> shard{};  // it made this alone: pages are those of the shard, and there are no layers
  bool is_change = false;        // of a dataset that was there (update.h); then, of the pages:
  int64_t written = 0;           // those that are new or have other bytes than before
  int64_t removed = 0;           // those that are no longer there
  int64_t bytes = 0;             // of the stores on disk
  int64_t bytes_read = 0;        // of source pixels, unpacked
  std::vector<LayerRecord> layers;
  std::vector<SourceRemark> skipped, warnings;
};

Result<BuildReport> Build(const BuildSpec& spec, const BuildOptions& options, const Clock& clock);

}  // namespace belvedere
