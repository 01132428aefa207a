#include "runtime/app/station.h"

#include "runtime/app/importance_file.h"
#include "runtime/app/settings.h"
#include "runtime/base/heap.h"
#include "runtime/base/log.h"
#include "runtime/paging/terrain_height.h"
#include "servers/stock_modules.h"

#include <algorithm>
#include <utility>

namespace belvedere {
namespace {

constexpr size_t kMostFailuresShown = 3;

}  // namespace

Result<std::unique_ptr<Station>> Station::Start(const StationOptions& options, const Clock& clock,
                                                std::unique_ptr<Context> context) {
  MapLargeBlocksAlone();
  std::unique_ptr<Station> station(new Station(clock));
  if (Status status = station->StartPaging(options); !status.ok()) return status;
  ObjectTable::Options table;
  table.timeout_s = options.feed.timeout_s;
  table.timeouts = options.feed.timeouts;
  table.capacity = options.feed.most_entities;
  station->objects_ = std::make_unique<ObjectTable>(table);
  if (Status status = station->StartClusters(options); !status.ok()) return status;
  station->StartReceivers(options.feed);
  Result<std::unique_ptr<RenderThread>> render =
      RenderThread::Start(options.render, station->paging_->layers, clock, std::move(context));
  if (!render.ok()) return render.status();
  station->render_ = std::move(*render);
  const RenderOptions complete = WithDefaults(options.render, station->render_->facts().software);
  station->image_slots_ = {complete.colour_slots, complete.overlay_slots};
  return station;
}

Status Station::StartPaging(const StationOptions& options) {
  Result<std::unique_ptr<LiveDataset>> dataset = LiveDataset::Open(options.dataset);
  if (!dataset.ok()) return dataset.status();
  dataset_ = std::move(*dataset);
  if (!dataset_->FindLayer(LayerKind::kElevation)) {
    start_notices_.push_back(options.dataset + " has no elevation layer: the Earth is drawn smooth");
  }
  if (!dataset_->FindLayer(LayerKind::kImagery)) {
    start_notices_.push_back(options.dataset + " has no imagery layer: the ground is drawn grey");
  }
  const std::string models = options.models.empty() ? BELVEDERE_MODELS_FOLDER : options.models;
  Result<Catalogue> catalogue = LoadCatalogue(models);
  if (catalogue.ok()) {
    catalogue_ = std::move(*catalogue);
  } else {
    start_notices_.push_back(catalogue.message() + "; objects are drawn as symbols");
  }
  const StockOptions stock{.exaggeration = options.exaggeration};
  if (Status status = RegisterStockModules(registry_, *dataset_, catalogue_.models, stock); !status.ok()) return status;
  for (const std::string& notice : start_notices_) LogWarning("{}", notice);

  paging_ = std::make_unique<Paging>(MakeLayerTable(registry_), options.cache_bytes, clock_);
  servers_ = std::make_unique<ServerSet>(*paging_, registry_);
  follower_ = std::make_unique<DatasetFollower>(*paging_, *dataset_, catalogue_.models, stock, clock_);
  const Layer* terrain = paging_->layers.FirstOf(PageKind::kTerrain);
  ground_ = [paging = paging_.get(), type = terrain->type](double latitude_deg, double longitude_deg) {
    const auto ground = GroundUnder(*paging, type, latitude_deg, longitude_deg);
    return ground ? ground->height_m : 0.0;
  };
  return {};
}

Status Station::StartClusters(const StationOptions& options) {
  const std::string models = options.models.empty() ? BELVEDERE_MODELS_FOLDER : options.models;
  ClusterOptions clusters;
  clusters.watched = options.watched;
  Result<ImportanceTable> table =
      LoadImportance(options.importance.empty() ? models + "/importance.toml" : options.importance);
  if (table.ok()) clusters.importance = std::move(*table);
  if (!table.ok() && !options.importance.empty()) return table.status();  // a folder of models may do without
  clusters_ = std::make_unique<ClusterManager>(*objects_, std::move(clusters), clock_);
  return {};
}

void Station::StartReceivers(const FeedSpec& feed) {
  for (const std::string& listen : feed.listen) {
    const Result<dis::Endpoint> endpoint = dis::ParseEndpoint(listen);
    Status status = endpoint.status();
    if (endpoint.ok()) {
      dis::ReceiverOptions options;
      options.network.listen = *endpoint;
      options.network.interface_address = feed.interface_address;
      options.intake = {feed.exercise, feed.admission, feed.scorch_s};
      Result<std::unique_ptr<dis::Receiver>> receiver = dis::Receiver::Start(options, *objects_, clock_);
      status = receiver.status();
      if (receiver.ok()) receivers_.push_back(std::move(*receiver));
    }
    if (status.ok()) continue;
    start_notices_.push_back(status.message());
    LogWarning("{}; going on without this feed", status.message());
  }
}

Station::~Station() {
  for (auto& [id, view] : views_) {
    view.objects.reset();
    view.terrain.reset();
  }
  // The lists in the channels pin pages, so they go before the cache does.
  render_.reset();
  views_.clear();
  receivers_.clear();
  clusters_.reset();
  follower_.reset();
  servers_.reset();
}

Result<std::vector<NamedLayer>> Station::ImageLayers(const std::vector<std::string>& texts) const {
  Result<std::vector<NamedLayer>> layers = LayersOf(texts, paging_->layers);
  if (!layers.ok()) return Status::Error("{}: {}", dataset_->path(), layers.message());
  return layers;
}

ViewChannel& Station::AddView(const ViewParameters& first, Presenter* presenter) {
  View& view = views_[first.view];
  view.channel = std::make_shared<ViewChannel>();
  view.channel->parameters.Publish(first);
  view.terrain = std::make_unique<TerrainManager>(first.view, *paging_, view.channel, image_slots_, clock_);
  view.objects = std::make_unique<ObjectManager>(first.view, *paging_, catalogue_.looks, *objects_, *clusters_,
                                                 view.channel, clock_);
  render_->AddView(first.view, view.channel, presenter);
  return *view.channel;
}

void Station::RemoveView(ViewId id) {
  const auto found = views_.find(id);
  if (found == views_.end()) return;
  found->second.objects.reset();
  found->second.terrain.reset();
  render_->RemoveView(id);
  views_.erase(found);
}

std::vector<std::string> Station::Notices() const {
  std::vector<std::string> notices = start_notices_;
  for (std::string& notice : follower_->Notices()) notices.push_back(std::move(notice));
  for (std::string& failure : paging_->cache.Failures(kMostFailuresShown)) notices.push_back(std::move(failure));
  const uint64_t failed = paging_->cache.Stats().failed_pages;
  if (failed > kMostFailuresShown) notices.push_back(fmt::format("{} pages failed in all", failed));
  return notices;
}

double Station::scene_hz(ViewId id) const {
  const auto found = views_.find(id);
  return found == views_.end() ? 0.0 : found->second.terrain->scene_hz();
}

}  // namespace belvedere
