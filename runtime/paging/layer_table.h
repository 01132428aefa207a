// LayerTable: the layers that this run of the program knows, each with its data type.
//
// Some come from the dataset, some are made by read modules from others. The table is filled at start and is read-only
// afterwards. It knows which quadnodes exist, so that nobody asks for what is not there: a layer's quadnodes form whole
// quadtrees in which the children of a quadnode exist together or not at all.
//
// A layer that changes with the simulation time has a data type for each of its steps (layer_steps.h). The one that is
// added first stands for them all: it has the layer's name and knows the steps, and views name no other.
//
// Threads: read by any once filled.
#pragma once

#include "runtime/paging/layer_steps.h"
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
  std::optional<StepOf> step{};         // it is one of several
  std::vector<LayerStep> steps{};       // of the one that stands for all; filled by LayerTable
  bool is_made = false;  // by a read module, from other pages or from nothing: shown where it is asked for
  // Whether a user may name it: it is no step, or the one that stands for all.
  bool is_whole() const { return !step || step->layer == name; }
};

class LayerTable {
 public:
  // Gives the layer the next data type and returns it. REQUIRES: no layer of that name yet; of a layer's steps, the one
  // that has the layer's own name comes first.
  DataType Add(Layer layer);

  const std::vector<Layer>& layers() const { return layers_; }
  const Layer& at(DataType type) const { return layers_[type]; }
  const Layer* Find(std::string_view name) const;
  const Layer* FirstOf(PageKind kind) const;
  int size() const { return static_cast<int>(layers_.size()); }

  // The data type of the step of the layer that holds at a simulation time; the layer's own where it has no steps.
  DataType TypeAt(DataType type, double utc_s) const;

  // The deepest existing quadnode of the layer that is `node` or an ancestor of it; nullopt where not even the root is.
  std::optional<Quadcode> DeepestExisting(DataType type, Quadcode node) const;

 private:
  void AddStep(const StepOf& step, DataType type);

  std::vector<Layer> layers_;
};

}  // namespace belvedere
