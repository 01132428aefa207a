#include "servers/stock_modules.h"

#include "servers/image_modules.h"
#include "servers/mip_levels.h"
#include "servers/model_reader.h"
#include "servers/property_tint.h"
#include "servers/terrain_builder.h"

#include <algorithm>
#include <optional>
#include <thread>
#include <utility>

namespace belvedere {
namespace {

// The first of a layer's steps in the dataset: it stands for all of them.
bool IsFirstStep(const Dataset& dataset, const LayerRecord& record) {
  if (!record.step) return false;
  const auto first = std::find_if(dataset.layers().begin(), dataset.layers().end(), [&](const LayerRecord& other) {
    return other.step && other.step->layer == record.step->layer;
  });
  return &*first == &record;
}

// A layer of the dataset, without the function that reads its pages.
ReadModule LayerOf(const Dataset& dataset, int layer, const LayerRecord& record, PageKind kind) {
  ReadModule module;
  module.layer = IsFirstStep(dataset, record) ? record.step->layer : record.name;
  module.step = record.step;
  module.kind = kind;
  module.max_level = record.max_level;
  module.exists = [&dataset, layer](Quadcode node) { return dataset.Exists(layer, node); };
  return module;
}

ReadModule ElevationModule(const Dataset& dataset, int layer, const LayerRecord& record) {
  ReadModule module = LayerOf(dataset, layer, record, PageKind::kElevation);
  module.read = [&dataset, layer](ReadContext&, Quadcode node) -> Result<std::unique_ptr<Page>> {
    Result<std::shared_ptr<ElevationPage>> page = dataset.ReadElevation(layer, node);
    if (!page.ok()) return page.status();
    return std::unique_ptr<Page>(std::make_unique<ElevationPage>(std::move(**page)));
  };
  return module;
}

ReadModule ImageryModule(const Dataset& dataset, int layer, const LayerRecord& record) {
  ReadModule module = LayerOf(dataset, layer, record, PageKind::kColour);
  module.read = [&dataset, layer](ReadContext&, Quadcode node) -> Result<std::unique_ptr<Page>> {
    Result<std::shared_ptr<ImagePage>> page = dataset.ReadImage(layer, node);
    if (!page.ok()) return page.status();
    FillMipLevels(**page);
    ColourRims(**page);
    return std::unique_ptr<Page>(std::make_unique<ImagePage>(std::move(**page)));
  };
  return module;
}

ReadModule PropertyModule(const Dataset& dataset, int layer, const LayerRecord& record) {
  ReadModule module = LayerOf(dataset, layer, record, PageKind::kColour);
  module.is_made = true;
  module.read = [&dataset, layer, &meaning = *record.property](ReadContext&,
                                                               Quadcode node) -> Result<std::unique_ptr<Page>> {
    const Result<std::shared_ptr<PropertyPage>> page = dataset.ReadProperty(layer, node);
    if (!page.ok()) return page.status();
    return std::unique_ptr<Page>(TintProperty(**page, meaning));
  };
  return module;
}

ReadModule ModuleOf(const Dataset& dataset, int layer, const LayerRecord& record) {
  if (record.kind == LayerKind::kElevation) return ElevationModule(dataset, layer, record);
  return record.kind == LayerKind::kImagery ? ImageryModule(dataset, layer, record)
                                            : PropertyModule(dataset, layer, record);
}

// The finest heights there are for a quadnode: its own page, or that of an ancestor; none where even the root is bad.
struct Heights {
  PagePin pin;
  Quadcode node;
};
std::optional<Heights> FinestHeights(ReadContext& context, const Dataset& dataset, int layer, DataType type,
                                     Quadcode node) {
  const int finest = dataset.MaxLevel(layer);
  if (node.level() > finest) node = node.Ancestor(finest);
  while (true) {
    if (dataset.Exists(layer, node)) {
      Result<PagePin> page = context.Obtain(type, node);  // a failure is marked in the cache, where the user sees it
      if (page.ok()) return Heights{std::move(*page), node};
    }
    if (node.is_root()) return std::nullopt;
    node = node.Parent();
  }
}

// The coarsest quadnode beyond a border whose posts there are no further apart; none beyond the poles.
std::optional<Quadcode> Beside(Quadcode node, Side side) {
  if (side == Side::kSouth || side == Side::kNorth) return node.BesideParallel(side == Side::kNorth);
  return Quadcode::FromColumnRow(node.level(), node.column() + (side == Side::kEast ? 1 : -1), node.row());
}

// Whether there is terrain: wherever any layer of the dataset has a page.
bool TerrainExists(const Dataset& dataset, Quadcode node) {
  if (node.is_root()) return true;
  for (int any = 0; any < static_cast<int>(dataset.layers().size()); ++any) {
    if (IsOfGround(dataset.layers()[static_cast<size_t>(any)].kind) && dataset.Exists(any, node)) return true;
  }
  return false;
}

// Lays the borders beyond which the heights are coarser on the surface there. REQUIRES: the input has heights.
void LayBorders(ReadContext& context, const Dataset& dataset, int layer, DataType type, TerrainInput& input) {
  for (const Side side : {Side::kWest, Side::kEast, Side::kSouth, Side::kNorth}) {
    const std::optional<Quadcode> beside = Beside(input.node, side);
    if (!beside || input.heights_node.Contains(*beside)) continue;
    const std::optional<Quadcode> as_fine = Beside(input.heights_node, side);
    if (as_fine && dataset.Exists(layer, *as_fine)) continue;
    TerrainInput coarser{
        .node = *beside, .heights = nullptr, .heights_node = *beside, .exaggeration = input.exaggeration};
    while (!TerrainExists(dataset, coarser.node)) coarser.node = coarser.node.Parent();
    const std::optional<Heights> heights = FinestHeights(context, dataset, layer, type, coarser.node);
    if (heights) {
      coarser.heights = &heights->pin.as<ElevationPage>();
      coarser.heights_node = heights->node;
    }
    const Side facing = static_cast<Side>(static_cast<unsigned>(side) ^ 1U);
    input.laid_ecef[static_cast<size_t>(side)] = LaidOn(input.node, side, coarser.node, BorderPosts(coarser, facing));
  }
}

Result<std::unique_ptr<Page>> ReadTerrain(ReadContext& context, const Dataset& dataset, const std::optional<int>& layer,
                                          DataType elevation, Quadcode node, double exaggeration) {
  TerrainInput input{.node = node, .heights = nullptr, .heights_node = node, .exaggeration = exaggeration};
  if (!layer) {
    input.finer_exists = true;  // the ellipsoid goes on being round at every level
    return std::unique_ptr<Page>(BuildTerrain(input));
  }
  const std::optional<Heights> heights = FinestHeights(context, dataset, *layer, elevation, node);
  if (heights) {
    input.heights = &heights->pin.as<ElevationPage>();
    input.heights_node = heights->node;
  }
  input.finer_exists = dataset.HasChildren(*layer, node);
  if (heights) LayBorders(context, dataset, *layer, elevation, input);
  return std::unique_ptr<Page>(BuildTerrain(input));
}

ReadModule TerrainModule(const Dataset& dataset, const std::optional<int>& layer, DataType elevation,
                         const StockOptions& options) {
  ReadModule module;
  module.layer = kTerrainLayer;
  module.kind = PageKind::kTerrain;
  const auto cores = static_cast<int>(std::max(std::thread::hardware_concurrency(), 1U));
  module.threads = options.terrain_threads > 0 ? options.terrain_threads : std::min(cores, kMostTerrainThreads);
  for (const LayerRecord& record : dataset.layers()) {
    if (IsOfGround(record.kind)) module.max_level = std::max(module.max_level, record.max_level);
  }
  module.exists = [&dataset](Quadcode node) { return TerrainExists(dataset, node); };
  module.read = [&dataset, layer, elevation, exaggeration = options.exaggeration](ReadContext& context, Quadcode node) {
    return ReadTerrain(context, dataset, layer, elevation, node, exaggeration);
  };
  return module;
}

ReadModule ModelModule(const ModelCatalogue& models) {
  ReadModule module;
  module.layer = kModelLayer;
  module.kind = PageKind::kModel;
  module.max_level = kMaxLevel;
  module.exists = [count = static_cast<int>(models.entries().size())](Quadcode node) {
    return ModelCatalogue::IsModelNode(node) && ModelCatalogue::ModelNumber(node) < count;
  };
  module.read = [&models](ReadContext&, Quadcode node) -> Result<std::unique_ptr<Page>> {
    Result<std::unique_ptr<ModelPage>> page = ReadModel(models, ModelCatalogue::ModelNumber(node));
    if (!page.ok()) return page.status();
    return std::unique_ptr<Page>(std::move(*page));
  };
  return module;
}

}  // namespace

Status RegisterStockModules(ModuleRegistry& registry, const Dataset& dataset, const ModelCatalogue& models,
                            const StockOptions& options) {
  BELVEDERE_CHECK(options.exaggeration > 0);
  for (int layer = 0; layer < static_cast<int>(dataset.layers().size()); ++layer) {
    const LayerRecord& record = dataset.layers()[static_cast<size_t>(layer)];
    if (!IsOfGround(record.kind)) continue;
    const Status added = registry.Add(ModuleOf(dataset, layer, record));
    if (!added.ok()) return Status::Error("{}: {}", dataset.path(), added.message());
  }
  const std::optional<int> layer = dataset.FindLayer(LayerKind::kElevation);
  const ReadModule* elevation = layer ? registry.Find(dataset.layers()[static_cast<size_t>(*layer)].name) : nullptr;

  std::vector<ReadModule> made;
  made.push_back(TerrainModule(dataset, layer, elevation != nullptr ? elevation->type : DataType{0}, options));
  for (ReadModule& module : ModulesOfQuadnodes(made.front())) made.push_back(std::move(module));
  if (elevation != nullptr) {
    for (ReadModule& module : ModulesOfHeights(*elevation)) made.push_back(std::move(module));
  }
  made.push_back(ModelModule(models));
  for (ReadModule& module : made) {
    const Status added = registry.Add(std::move(module));
    if (!added.ok()) return Status::Error("{}: {}", dataset.path(), added.message());
  }
  return {};
}

}  // namespace belvedere
