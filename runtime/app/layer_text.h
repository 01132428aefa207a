// The written form of an image layer of a view, as station files, --layers and commands have it:
//
//   NAME[:off][:opacity=0..1][:gamma=0.1..10][:multiplier=0..100][:role=colour|grey|multiply|night|water]
//
// Threads: pure functions.
#pragma once

#include "runtime/base/status.h"
#include "runtime/paging/layer_table.h"
#include "runtime/scene/view_parameters.h"

#include <string>
#include <string_view>
#include <vector>

namespace belvedere {

// What "[:key=value]..." says of a layer. use.type is the layer's; the role is its own unless the text says otherwise.
struct NamedLayer {
  std::string name;
  LayerUse use;
};

// The image layers of the table that the texts name, in that order. With no texts: the first colour layer of the
// dataset and every one that multiplies it. A Status where a layer is not known, is named twice, or its text is wrong.
Result<std::vector<NamedLayer>> LayersOf(const std::vector<std::string>& texts, const LayerTable& table);

// Changes `use` as one setting says ("opacity=0.5", "off").
Status ApplyLayerSetting(std::string_view setting, LayerUse& use);

std::vector<LayerUse> UsesOf(const std::vector<NamedLayer>& layers);

}  // namespace belvedere
