// Station: all the rooms, started and stopped in order.
//
//   start   dataset -> layers -> paging -> servers -> follower -> object table, clusters and receivers -> render thread
//   ->
//           views
//   stop    views' managers -> render thread -> channels -> receivers -> clusters -> follower -> servers -> paging ->
//   dataset
//
// A dataset that is changed or built anew on disk is followed while the station runs (dataset_follower.h).
//
// A view is a channel with its two managers, drawn by the render thread in a window or off-screen. What can be done
// without is done without: a feed whose port is taken or a folder without models is a line for the user, not an end.
//
// Start also has the heap give large blocks back to the system, for the whole process (runtime/base/heap.h).
//
// Threads: the UI thread. Owns every other thread but that of a traffic sender.
#pragma once

#include "dis/receiver.h"
#include "managers/cluster_manager.h"
#include "managers/object_manager.h"
#include "managers/terrain_manager.h"
#include "render/render_thread.h"
#include "runtime/app/catalogue_file.h"
#include "runtime/app/ground.h"
#include "runtime/app/layer_text.h"
#include "runtime/app/station_file.h"
#include "runtime/paging/live_dataset.h"
#include "servers/dataset_follower.h"
#include "servers/page_server.h"
#include "servers/read_module.h"

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace belvedere {

struct StationOptions {
  std::string dataset;
  std::string models;  // empty: the project's own
  size_t cache_bytes = size_t{512} << 20;
  double exaggeration = 1;
  FeedSpec feed;
  std::string importance;          // file of the importance table; empty: that of the models' folder
  std::vector<WatchArea> watched;  // what is near these matters more
  RenderOptions render;
};

class Station {
 public:
  static Result<std::unique_ptr<Station>> Start(const StationOptions& options, const Clock& clock,
                                                std::unique_ptr<Context> context);
  ~Station();
  Station(const Station&) = delete;
  Station& operator=(const Station&) = delete;

  // The image layers that the texts name (layer_text.h); with none, those that a view has unless it says otherwise.
  Result<std::vector<NamedLayer>> ImageLayers(const std::vector<std::string>& texts) const;

  // first: the view's parameters until others are published, with the number that the view is to have.
  ViewChannel& AddView(const ViewParameters& first, Presenter* presenter);
  // Returns when nothing of the view runs any more.
  void RemoveView(ViewId id);

  // From now on groups near these matter more, and no others.
  void Watch(const std::vector<WatchArea>& areas) { clusters_->Watch(areas); }

  // Never under the surface that is drawn; the ellipsoid while nothing is there yet. Valid as long as the station.
  const GroundHeight& ground() const { return ground_; }
  // Lines for the user about what is wrong, at most a few.
  std::vector<std::string> Notices() const;
  double scene_hz(ViewId id) const;

  Paging& paging() { return *paging_; }
  ObjectTable& objects() { return *objects_; }
  RenderThread& render() { return *render_; }
  const std::vector<std::unique_ptr<dis::Receiver>>& receivers() const { return receivers_; }

 private:
  struct View {
    std::shared_ptr<ViewChannel> channel;
    std::unique_ptr<TerrainManager> terrain;
    std::unique_ptr<ObjectManager> objects;
  };

  explicit Station(const Clock& clock) : clock_(clock) {}
  Status StartPaging(const StationOptions& options);
  Status StartClusters(const StationOptions& options);
  void StartReceivers(const FeedSpec& feed);

  const Clock& clock_;
  ImageLimits image_slots_;  // on the GPU
  std::unique_ptr<LiveDataset> dataset_;
  Catalogue catalogue_;
  ModuleRegistry registry_;
  std::unique_ptr<Paging> paging_;
  std::unique_ptr<ServerSet> servers_;
  std::unique_ptr<DatasetFollower> follower_;
  std::unique_ptr<ObjectTable> objects_;
  std::unique_ptr<ClusterManager> clusters_;
  std::vector<std::unique_ptr<dis::Receiver>> receivers_;
  std::unique_ptr<RenderThread> render_;
  std::map<ViewId, View> views_;
  GroundHeight ground_;
  std::vector<std::string> start_notices_;
};

}  // namespace belvedere
