// KnownPages: pages that a build need not make, since they are there as it would make them: those of a build that was
// interrupted, or those of a dataset of which only a part changes.
//
// Threads: all methods, any.
#pragma once

#include "preproc/surface_error.h"
#include "runtime/base/status.h"
#include "runtime/earth/quadcode.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace belvedere {

// Deviations are kept of pages with so many levels under them, or more; those of others are found anew from the few
// pages that these have.
inline constexpr int kDepthWithDeviations = 3;

class KnownPages {
 public:
  virtual ~KnownPages() = default;
  // Whether the page and all that is under it are as the build would make them.
  virtual bool Knows(int layer, Quadcode node) const = 0;
  // The build has come to the page, which is known, and leaves it and all under it as they are.
  virtual void Take(int /*layer*/, Quadcode /*node*/) {}
  // Of pages that are known: as stored.
  virtual bool Exists(int layer, Quadcode node) const = 0;
  virtual std::optional<std::vector<uint8_t>> Page(int layer, Quadcode node) const = 0;
  virtual std::optional<std::vector<uint8_t>> Deviations(int layer, Quadcode node) const = 0;
};

// An elevation page that is known, as if it had just been made. The reason alone where its bytes are bad.
Result<BoundedPage> ReadBounded(const KnownPages& known, int layer, Quadcode node);

}  // namespace belvedere
