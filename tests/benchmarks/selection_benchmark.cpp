// What terrain selection costs and yields: quadnodes, triangles and milliseconds of a display list at poses along a
// camera path, with every page in memory and taken to be on the GPU. No rendering, no threads.
//
// Usage: selection_benchmark DATASET PATH.csv [ERROR_PX]
// PATH.csv is a camera path as `belvedere tour` takes it; every tenth row is a pose.

#include "managers/cut.h"
#include "managers/list_pages.h"
#include "managers/surface_mesh.h"
#include "runtime/earth/ellipsoid.h"
#include "runtime/paging/terrain_height.h"
#include "servers/stock_modules.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <unordered_set>

namespace belvedere {
namespace {

constexpr int kRowsPerPose = 10;
constexpr int kMostRounds = 60;
constexpr int kTimedBuilds = 20;

struct Scene {
  std::unique_ptr<Dataset> dataset;
  ModelCatalogue models;
  ModuleRegistry registry;
  std::unique_ptr<Paging> paging;
  DataType terrain = 0;
  std::vector<PagePin> on_gpu;
  std::unordered_set<const Page*> placed;
  SurfaceState surface;
};

// Reads what a list wished for and pretends to upload it. False when there was nothing to do.
bool Serve(Scene& scene, DisplayList& list) {
  bool any = false;
  for (const auto& queue : scene.paging->queues) {
    while (const std::optional<PageKey> key = queue->TryTake()) {
      any = true;
      Result<PagePin> pin = ReadIntoCache(*scene.paging, scene.registry, *key);
      if (pin.ok()) scene.on_gpu.push_back(std::move(*pin));
      queue->Done(*key);
    }
  }
  for (const PagePin& pin : list.uploads) scene.on_gpu.push_back(pin.Share());
  for (const PagePin& pin : scene.on_gpu) {
    if (!scene.placed.insert(&pin.page()).second) continue;
    any = true;
    pin.page().residency()->Place(static_cast<int>(scene.placed.size()));
  }
  return any;
}

struct Built {
  double cut_ms = 0, mesh_ms = 0;
  Cut cut;
  MeshStatistics mesh;
};

Built Build(Scene& scene, const ViewParameters& view, DisplayList& list) {
  const Clock& clock = Clock::System();
  list.Clear();
  const Geodetic eye = ToGeodetic(view.eye_ecef);
  const auto ground = GroundUnder(*scene.paging, scene.terrain, eye.latitude_deg, eye.longitude_deg);
  const ViewMatrices matrices = MatricesOf(view, 0, std::max(0.0, eye.height_m - (ground ? ground->height_m : 0)));
  Built built;
  ListPages pages(*scene.paging, scene.terrain, list);
  const double start = clock.NowSeconds();
  built.cut = SelectCut(view, matrices, scene.paging->layers, scene.terrain, {}, pages);
  const double middle = clock.NowSeconds();
  built.mesh = BuildSurface(built.cut.nodes, SightOf(view, matrices.eye_ecef), view.error_px, scene.surface, list);
  built.cut_ms = (middle - start) * 1e3;
  built.mesh_ms = (clock.NowSeconds() - middle) * 1e3;
  pages.Finish(view.view, ListPages::Queues::kTerrain);
  return built;
}

void Report(Scene& scene, const ViewParameters& view, double time_s) {
  DisplayList list;
  int rounds = 0;
  do {
    Build(scene, view, list);
  } while (Serve(scene, list) && ++rounds < kMostRounds);
  std::vector<double> cut_ms, mesh_ms;
  Built built;
  for (int i = 0; i < kTimedBuilds; ++i) {
    built = Build(scene, view, list);
    cut_ms.push_back(built.cut_ms);
    mesh_ms.push_back(built.mesh_ms);
  }
  const auto median = [](std::vector<double>& values) {
    std::nth_element(values.begin(), values.begin() + kTimedBuilds / 2, values.end());
    return values[kTimedBuilds / 2];
  };
  int deepest = 0;
  uint32_t visible = 0;
  uint32_t visible_triangles = 0;
  for (size_t i = 0; i < built.cut.nodes.size(); ++i) {
    const CutNode& node = built.cut.nodes[i];
    deepest = std::max(deepest, node.node.level());
    visible += node.visible ? 1 : 0;
    visible_triangles += node.visible ? list.terrain_draws[i].index_count / 3 : 0;
  }
  fmt::print(
      "{:6.1f} s {:9.0f} m: rounds {:2}, nodes {:3} ({:3} seen), deepest {:2}, triangles {:6} ({:6} seen), "
      "cut {:.2f} ms, mesh {:.2f} ms, error {:.2f} px{}\n",
      time_s, ToGeodetic(view.eye_ecef).height_m, rounds, built.cut.nodes.size(), visible, deepest,
      built.mesh.triangles, visible_triangles, median(cut_ms), median(mesh_ms), built.mesh.achieved_error_px,
      built.cut.behind ? ", behind" : "");
}

int Run(const char* dataset_path, const char* path_file, double error_px) {
  Scene scene;
  Result<std::unique_ptr<Dataset>> dataset = Dataset::Open(dataset_path);
  if (!dataset.ok()) {
    fmt::print(stderr, "{}\n", dataset.message());
    return 1;
  }
  scene.dataset = std::move(*dataset);
  if (const Status status = RegisterStockModules(scene.registry, *scene.dataset, scene.models, {}); !status.ok()) {
    fmt::print(stderr, "{}\n", status.message());
    return 1;
  }
  scene.paging = std::make_unique<Paging>(MakeLayerTable(scene.registry), size_t{4} << 30, Clock::System());
  scene.terrain = scene.paging->layers.Find(kTerrainLayer)->type;

  ViewParameters view;
  view.number = 1;
  view.error_px = error_px;
  for (const Layer& layer : scene.paging->layers.layers()) {
    if (layer.kind == PageKind::kColour || layer.kind == PageKind::kOverlay)
      view.image_layers.push_back({layer.type, layer.role});
  }
  std::ifstream file(path_file);
  std::string line;
  std::getline(file, line);  // names
  for (int row = 0; std::getline(file, line); ++row) {
    if (row % kRowsPerPose != 0) continue;
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream numbers(line);
    double t = 0, latitude = 0, longitude = 0, height = 0, heading = 0, pitch = 0, roll = 0, vfov = 0;
    numbers >> t >> latitude >> longitude >> height >> heading >> pitch >> roll >> vfov;
    view.eye_ecef = ToEcef({latitude, longitude, height});
    view.ecef_from_camera = CameraAxes(latitude, longitude, Radians::FromDegrees(heading), Radians::FromDegrees(pitch),
                                       Radians::FromDegrees(roll));
    view.vertical_fov = Radians::FromDegrees(vfov);
    Report(scene, view, t);
  }
  scene.on_gpu.clear();
  return 0;
}

}  // namespace
}  // namespace belvedere

int main(int argc, char** argv) {
  if (argc != 3 && argc != 4) {
    fmt::print(stderr, "usage: {} DATASET PATH.csv [ERROR_PX]\n", argv[0]);
    return 2;
  }
  return belvedere::Run(argv[1], argv[2], argc == 4 ? std::atof(argv[3]) : 2.0);
}
