// LayerTable: the layers that this run of the program knows, each with its data type.
//
// Some come from the dataset, some are made by read modules from others. The table is filled at start and is read-only
// afterwards. It knows which quadnodes exist, so that nobody asks for what is not there: a layer's quadnodes form whole
// quadtrees in which the four children of a quadnode exist together or not at all.
//
// Threads: read by any once filled.
#pragma once

#include "runtime/paging/page.h"

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace belvedere {

enum class PageKind : uint8_t {
  kElevation,  // ElevationPage
  kTerrain,    // TerrainPage
  kColour,     // ImagePage, RGBA
  kOverlay,    // ImagePage, R
  kModel,      // ModelPage
};

// What an image layer does to the ground's colour under it.
enum class LayerRole : uint8_t {
  kColour,    // lies over it, as its alpha says
  kGrey,      // likewise, without its hue
  kMultiply,  // multiplies it: 0.5 leaves it as it is, 1 doubles it
  kNight,     // shines where the sun is down
  kWater,     // where it is 1 the sun glints
};

struct Layer {
  std::string name;  // as the dataset, or the read module, calls it
  PageKind kind = PageKind::kElevation;
  DataType type = 0;
  int max_level = 0;
  // Whether the layer has a page for the quadnode.
  std::function<bool(Quadcode)> exists;
  LayerRole role = LayerRole::kColour;  // of an image layer, unless a view says otherwise
};

class LayerTable {
 public:
  // Gives the layer the next data type and returns it. REQUIRES: no layer of that name yet.
  DataType Add(Layer layer);

  const std::vector<Layer>& layers() const { return layers_; }
  const Layer& at(DataType type) const { return layers_[type]; }
  const Layer* Find(std::string_view name) const;
  const Layer* FirstOf(PageKind kind) const;
  int size() const { return static_cast<int>(layers_.size()); }

  // The deepest existing quadnode of the layer that is `node` or an ancestor of it; nullopt where not even the root is.
  std::optional<Quadcode> DeepestExisting(DataType type, Quadcode node) const;

 private:
  std::vector<Layer> layers_;
};

}  // namespace belvedere
