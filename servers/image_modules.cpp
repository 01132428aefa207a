#include "servers/image_modules.h"

#include "runtime/base/log.h"
#include "runtime/earth/geoid.h"
#include "servers/contours.h"
#include "servers/graticule.h"
#include "servers/page_text.h"
#include "servers/quadcode_frame.h"
#include "servers/shaded_relief.h"
#include "servers/slope_tint.h"
#include "servers/stock_modules.h"
#include "servers/water_mask.h"

#include <memory>
#include <utility>

namespace belvedere {
namespace {

// One for the whole program, made by the first who asks.
const PageText& Text() {
  static const PageText kText;
  return kText;
}

// draw: from heights and their quadnode.
template <class Draw>
ReadModule OfHeights(const char* layer, PageKind kind, LayerRole role, const ReadModule& elevation, Draw draw) {
  ReadModule module;
  module.layer = layer;
  module.kind = kind;
  module.role = role;
  module.is_made = true;
  module.max_level = elevation.max_level;
  module.exists = elevation.exists;
  module.read = [draw = std::move(draw), type = elevation.type](ReadContext& context,
                                                                Quadcode node) -> Result<std::unique_ptr<Page>> {
    const Result<PagePin> heights = context.Obtain(type, node);
    if (!heights.ok()) return heights.status();
    return std::unique_ptr<Page>(draw(heights->as<ElevationPage>(), node));
  };
  return module;
}

using DrawQuadnode = std::unique_ptr<ImagePage> (*)(Quadcode, const PageText&);
ReadModule OfQuadnodes(const char* layer, const ReadModule& terrain, DrawQuadnode draw) {
  ReadModule module;
  module.layer = layer;
  module.kind = PageKind::kColour;
  module.is_made = true;
  module.max_level = terrain.max_level;
  module.exists = terrain.exists;
  module.read = [draw](ReadContext&, Quadcode node) -> Result<std::unique_ptr<Page>> {
    return std::unique_ptr<Page>(draw(node, Text()));
  };
  return module;
}

}  // namespace

std::vector<ReadModule> ModulesOfHeights(const ReadModule& elevation) {
  std::shared_ptr<const Geoid> sea;  // without it, the sea is that of the ellipsoid
  if (Result<std::shared_ptr<const Geoid>> geoid = Geoid::LoadEgm96(); geoid.ok()) sea = *geoid;
  std::vector<ReadModule> modules;
  modules.push_back(
      OfHeights(kReliefLayer, PageKind::kOverlay, LayerRole::kMultiply, elevation,
                [sea](const ElevationPage& heights, Quadcode node) { return ShadeRelief(heights, node, sea.get()); }));
  modules.push_back(OfHeights(kSlopeLayer, PageKind::kColour, LayerRole::kColour, elevation, TintSlopes));
  modules.push_back(OfHeights(
      kContourLayer, PageKind::kColour, LayerRole::kColour, elevation,
      [sea](const ElevationPage& heights, Quadcode node) { return DrawContours(heights, node, sea.get(), Text()); }));
  modules.push_back(
      OfHeights(kWaterLayer, PageKind::kOverlay, LayerRole::kWater, elevation,
                [sea](const ElevationPage& heights, Quadcode node) { return MaskWater(heights, node, sea.get()); }));
  return modules;
}

std::vector<ReadModule> ModulesOfQuadnodes(const ReadModule& terrain) {
  if (!Text().font().ok()) LogWarning("{}", Text().font().message());
  std::vector<ReadModule> modules;
  modules.push_back(OfQuadnodes(kGridLayer, terrain, DrawGraticule));
  modules.push_back(OfQuadnodes(kQuadcodeLayer, terrain, DrawQuadcodeFrame));
  return modules;
}

}  // namespace belvedere
