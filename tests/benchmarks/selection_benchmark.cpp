// What terrain selection costs and yields: quadnodes, triangles and milliseconds of a display list at poses along a
// camera path, with every page in memory and taken to be on the GPU, for an eye that stands still and for one that goes
// on along the path. No rendering, no threads.
//
// Usage: selection_benchmark DATASET PATH.csv [ERROR_PX]
// PATH.csv is a camera path as `belvedere tour` takes it; every ten seconds of it are a pose.

#include "managers/surface_mesh.h"
#include "runtime/app/camera_path.h"
#include "runtime/app/layer_text.h"
#include "tests/figures/paged_dataset.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <utility>

namespace belvedere {
namespace {

constexpr double kSecondsPerPose = 10;
constexpr int kMostRounds = 60;
constexpr int kTimedBuilds = 30;
constexpr double kSecondsPerList = 1.0 / 30;

struct Scene {
  std::unique_ptr<figures::PagedDataset> paged;
  SurfaceState surface;
};

struct Built {
  double cut_ms = 0, mesh_ms = 0;
  Cut cut;
  MeshStatistics mesh;
};

Built Build(Scene& scene, const ViewParameters& view, double now_s, DisplayList& list) {
  const Clock& clock = Clock::System();
  list.Clear();
  list.time_s = now_s;
  const ViewMatrices matrices = scene.paged->MatricesFor(view);
  Built built;
  ListPages pages(scene.paged->paging(), scene.paged->terrain(), list);
  const double start = clock.NowSeconds();
  built.cut = SelectCut(view, matrices, scene.paged->layers(), scene.paged->terrain(), {}, pages);
  const double middle = clock.NowSeconds();
  scene.surface.morph.Begin(now_s, false);
  built.mesh = BuildSurface(built.cut.nodes, SightOf(view, matrices.eye_ecef), view.error_px, scene.surface, list);
  built.cut_ms = (middle - start) * 1e3;
  built.mesh_ms = (clock.NowSeconds() - middle) * 1e3;
  pages.Finish(view.view, ListPages::Queues::kTerrain);
  return built;
}

void Look(const CameraPose& pose, ViewParameters& view) {
  view.eye_ecef = pose.eye_ecef();
  view.ecef_from_camera = pose.ecef_from_camera();
  view.vertical_fov = Radians::FromDegrees(pose.vfov_deg);
}

double Median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

struct Timed {
  Built last;
  double cut_ms = 0, mesh_ms = 0;
};

// seconds_per_list: by which the eye goes on along the path.
Timed TimeLists(Scene& scene, const CameraPath& path, double start_s, double seconds_per_list, ViewParameters& view,
                std::array<DisplayList, 3>& lists) {
  std::vector<double> cut_ms, mesh_ms;
  Timed timed;
  for (int i = 0; i < kTimedBuilds; ++i) {
    DisplayList& list = lists[static_cast<size_t>(i) % lists.size()];
    Look(path.PoseAt(start_s + i * seconds_per_list), view);
    timed.last = Build(scene, view, start_s + i * kSecondsPerList, list);
    while (scene.paged->Serve(list)) {
    }
    cut_ms.push_back(timed.last.cut_ms);
    mesh_ms.push_back(timed.last.mesh_ms);
  }
  timed.cut_ms = Median(cut_ms);
  timed.mesh_ms = Median(mesh_ms);
  return timed;
}

// Adds to the sums of milliseconds for a list, still and in motion.
void Report(Scene& scene, const CameraPath& path, double time_s, ViewParameters& view, std::array<double, 2>& sums) {
  std::array<DisplayList, 3> lists;
  DisplayList& list = lists[(kTimedBuilds - 1) % lists.size()];  // the last that is timed
  int rounds = 0;
  Look(path.PoseAt(time_s), view);
  do {
    Build(scene, view, time_s - 10, list);
  } while (scene.paged->Serve(list) && ++rounds < kMostRounds);
  const Timed still = TimeLists(scene, path, time_s, 0, view, lists);
  const Built& built = still.last;
  int deepest = 0;
  uint32_t visible = 0;
  uint32_t visible_triangles = 0;
  for (size_t i = 0; i < built.cut.nodes.size(); ++i) {
    const CutNode& node = built.cut.nodes[i];
    deepest = std::max(deepest, node.node.level());
    visible += node.visible ? 1 : 0;
    visible_triangles += node.visible ? list.terrain_draws[i].index_count / 3 : 0;
  }
  const double height_m = ToGeodetic(view.eye_ecef).height_m;
  const uint64_t chosen = scene.surface.kept.chosen();
  const Timed moving = TimeLists(scene, path, time_s, kSecondsPerList, view, lists);
  fmt::print(
      "{:6.1f} s {:9.0f} m: rounds {:2}, nodes {:3} ({:3} seen), deepest {:2}, triangles {:6} ({:6} seen), error "
      "{:.2f} "
      "px{}; cut {:.2f} ms, mesh {:.2f} ms; in motion cut {:.2f} ms, mesh {:.2f} ms, {:.0f} quadnodes chosen a list\n",
      time_s, height_m, rounds, built.cut.nodes.size(), visible, deepest, built.mesh.triangles, visible_triangles,
      built.mesh.achieved_error_px, built.cut.behind ? ", behind" : "", still.cut_ms, still.mesh_ms, moving.cut_ms,
      moving.mesh_ms, static_cast<double>(scene.surface.kept.chosen() - chosen) / kTimedBuilds);
  sums[0] += still.cut_ms + still.mesh_ms;
  sums[1] += moving.cut_ms + moving.mesh_ms;
}

int Run(const char* dataset_path, const char* path_file, double error_px) {
  const Result<CameraPath> path = CameraPath::Load(path_file);
  if (!path.ok()) {
    fmt::print(stderr, "{}\n", path.message());
    return 1;
  }
  Scene scene;
  Result<std::unique_ptr<figures::PagedDataset>> paged = figures::PagedDataset::Open(dataset_path);
  if (!paged.ok()) {
    fmt::print(stderr, "{}\n", paged.message());
    return 1;
  }
  scene.paged = std::move(*paged);

  ViewParameters view;
  view.number = 1;
  view.error_px = error_px;
  view.image_layers = UsesOf(*LayersOf({}, scene.paged->layers()));
  std::array<double, 2> sums{};
  for (double time_s = 0; time_s < path->length_s(); time_s += kSecondsPerPose) {
    Report(scene, *path, time_s, view, sums);
  }
  fmt::print("sum of medians: {:.2f} ms still, {:.2f} ms in motion\n", sums[0], sums[1]);
  scene.paged->Unpin();
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
