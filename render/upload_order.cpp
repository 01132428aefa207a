#include "render/upload_order.h"

#include <algorithm>
#include <unordered_set>

namespace belvedere {

std::vector<const PagePin*> FairUploadOrder(std::span<const std::span<const PagePin>> wishes, size_t turn) {
  std::vector<const PagePin*> order;
  std::unordered_set<const Residency*> seen;
  size_t longest = 0;
  for (const auto& list : wishes) longest = std::max(longest, list.size());
  for (size_t rank = 0; rank < longest; ++rank) {
    for (size_t i = 0; i < wishes.size(); ++i) {
      const auto& list = wishes[(i + turn) % wishes.size()];
      if (rank >= list.size()) continue;
      const Residency* residency = list[rank].page().residency().get();
      if (residency->on_gpu() || !seen.insert(residency).second) continue;
      order.push_back(&list[rank]);
    }
  }
  return order;
}

}  // namespace belvedere
