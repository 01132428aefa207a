#include "managers/image_fade.h"

#include <algorithm>
#include <utility>

namespace belvedere {
namespace {

bool IsSame(const ImageUse& image, const ImageUse& other) {
  return image.type == other.type && image.source == other.source;
}

}  // namespace

void ImageFade::Apply(std::span<CutNode> nodes, std::span<const LayerUse> layers, double now_s, bool jump,
                      PageAccess& pages) {
  std::swap(shown_, before_);
  shown_.clear();
  until_s_ = 0;
  waits_ = false;
  for (CutNode& node : nodes) {
    Shown& shown = shown_[node.node];
    std::copy_n(node.images.begin(), kFadingLayers, shown.images.begin());
    if (jump || !node.visible) continue;
    Quadcode ancestor = node.node;
    auto found = before_.find(ancestor);
    while (found == before_.end() && !ancestor.is_root()) {
      ancestor = ancestor.Parent();
      found = before_.find(ancestor);
    }
    if (found == before_.end()) continue;
    for (size_t layer = 0; layer < std::min<size_t>(kFadingLayers, layers.size()); ++layer) {
      if (layers[layer].shown()) Continue(found->second, layer, ancestor, now_s, node, shown, pages);
    }
  }
}

void ImageFade::Continue(const Shown& before, size_t layer, Quadcode before_node, double now_s, CutNode& node,
                         Shown& shown, PageAccess& pages) {
  const ImageUse last = PartOf(before.images[layer], before_node, node.node);
  if (last.slot < 0 || node.images[layer].slot < 0) return;
  const auto on_gpu = [&](const ImageUse& image) {
    return image.slot >= 0 && pages.Slot({image.type, image.source}) == image.slot;
  };
  const bool fading = now_s < before.until_s[layer];
  if (!fading && IsSame(last, node.images[layer])) return;
  if (!on_gpu(last)) return;
  const ImageUse from = fading ? PartOf(before.from[layer], before_node, node.node) : last;
  if (!on_gpu(from)) return;
  if (fading && !IsSame(last, node.images[layer])) {
    node.images[layer] = last;  // what comes next waits
    waits_ = true;
  }
  node.from[layer] = from;
  node.fade_until_s[layer] = fading ? before.until_s[layer] : now_s + kFade_s;
  shown.images[layer] = node.images[layer];
  shown.from[layer] = from;
  shown.until_s[layer] = node.fade_until_s[layer];
  until_s_ = std::max(until_s_, node.fade_until_s[layer]);
}

}  // namespace belvedere
