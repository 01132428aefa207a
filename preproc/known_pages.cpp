#include "preproc/known_pages.h"

#include "preproc/deviation_codec.h"
#include "runtime/paging/page_codec.h"

#include <algorithm>
#include <array>
#include <memory>
#include <utility>

namespace belvedere {
namespace {

bool HasChildren(const KnownPages& known, int layer, Quadcode node) {
  return node.level() < kMaxLevel && known.Exists(layer, node.Child(0));
}

// Finds the deviations from the pages under it.
Result<BoundedPage> BoundedByChildren(const KnownPages& known, int layer, Quadcode node,
                                      std::shared_ptr<ElevationPage> page) {
  std::array<BoundedPage, 4> finer;
  int depth = 0;
  for (const int which : node.Children()) {
    auto child = ReadBounded(known, layer, node.Child(which));
    if (!child.ok()) return child;
    depth = std::max(depth, child->depth);
    finer[static_cast<size_t>(which)] = std::move(*child);
  }
  HalveWide(node, finer);
  const float stored_error_m = page->error_m;
  CellDeviations deviations = BoundPage(*page, &finer);
  if (page->error_m != stored_error_m)
    return Status::Error("quadnode {} has another error than those under it say", node.ToString());
  return BoundedPage{std::move(page), std::move(deviations), depth + 1};
}

}  // namespace

Result<BoundedPage> ReadBounded(const KnownPages& known, int layer, Quadcode node) {
  const auto bytes = known.Page(layer, node);
  if (!bytes) return Status::Error("quadnode {} is not there", node.ToString());
  auto page = DecodeElevation(*bytes);
  if (!page.ok()) return Status::Error("quadnode {}: {}", node.ToString(), page.message());
  if (!HasChildren(known, layer, node))
    return BoundedPage{std::move(*page), CellDeviations(static_cast<size_t>(kCells) * kCells), 0};
  const auto stored = known.Deviations(layer, node);
  if (!stored) return BoundedByChildren(known, layer, node, std::move(*page));
  auto deviations = DecodeDeviations(*stored);
  if (!deviations.ok()) return Status::Error("quadnode {}: {}", node.ToString(), deviations.message());
  return BoundedPage{std::move(*page), std::move(*deviations), kDepthWithDeviations};
}

}  // namespace belvedere
