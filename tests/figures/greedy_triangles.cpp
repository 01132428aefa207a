// Greedy triangles: how many triangles are drawn for a bound of 1 px, over how many a greedy full search over the same
// hierarchy needs.
//
// For each pose, quadnodes and triangles are chosen by the terrain manager's own code, with every page in memory and
// nothing chosen before. Beside them stands what the search (greedy_search.h) finds: it starts from the 32 roots and
// splits whatever leaves an error over the bound, errors being looked up at every full-resolution post in the picture
// and at no other. Both are joined at the borders of quadnodes by the same code, and counted in the same two ways:
//
//   in picture  triangles that are themselves in the frustum and before the horizon. The ratio is of these.
//   in all      triangles that are handed to drawing: all of the quadnodes of which something may be seen.
//
// `same cut` is the search within the very quadnodes that are drawn: what lies between it and what is drawn is due to
// the bounds on errors, the rest to the choice of quadnodes. px is the largest error of the triangles in the picture.
//
// What it leaves out. The search is greedy, not the least there is: it stops at the first triangle within the bound,
// and never draws a quadnode's children for want of triangles alone. It does not heed images, which ask for quadnodes
// too. Neither side's errors know of the posts that a neighbour adds to an edge. Hills hide nothing. An eye in motion,
// whose lists keep triangles of those before, draws a few more.
//
// Usage: greedy_triangles DATASET [POSES]
// Prints a line a pose; the last line has the ratio of all triangles in the picture, the mean and the largest of poses.

#include "managers/list_pages.h"
#include "managers/surface_mesh.h"
#include "runtime/app/layer_text.h"
#include "tests/figures/greedy_search.h"
#include "tests/figures/paged_dataset.h"
#include "tests/figures/poses.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <deque>
#include <unordered_map>

namespace belvedere::figures {
namespace {

constexpr double kBound_px = 1.0;
constexpr int kMostRounds = 60;

[[noreturn]] void Give(const std::string& line) {
  fmt::print(stderr, "greedy_triangles: {}\n", line);
  std::exit(1);
}

// All pages, read where they are asked for.
class Pages final : public Terrain {
 public:
  explicit Pages(const std::string& path) {
    Result<std::unique_ptr<PagedDataset>> paged = PagedDataset::Open(path);
    if (!paged.ok()) Give(paged.message());
    paged_ = std::move(*paged);
    const std::optional<int> heights = dataset().FindLayer(LayerKind::kElevation);
    if (!heights) Give("the dataset has no heights");
    heights_ = *heights;
  }

  const Dataset& dataset() const { return paged_->dataset(); }
  const LayerTable& layers() const { return paged_->layers(); }

  const TerrainPage& PageOf(Quadcode node) override {
    PagePin& pin = pins_[node];
    if (!pin) {
      Result<PagePin> read = paged_->Read({paged_->terrain(), node});
      if (!read.ok()) Give(read.message());
      pin = std::move(*read);
    }
    return pin.as<TerrainPage>();
  }
  bool HasFiner(Quadcode node) const override { return dataset().HasChildren(heights_, node); }

  // Ends a pose.
  void Unpin() {
    pins_.clear();
    paged_->Unpin();
  }

  ViewMatrices MatricesFor(const ViewParameters& view) { return paged_->MatricesFor(view); }

  // The cut as it is once all its pages have come.
  Cut SettledCut(const ViewParameters& view) {
    for (int round = 0; round < kMostRounds; ++round) {
      DisplayList list;
      ListPages pages(paged_->paging(), paged_->terrain(), list);
      Cut cut = SelectCut(view, MatricesFor(view), layers(), paged_->terrain(), {}, pages);
      pages.Finish(view.view, ListPages::Queues::kTerrain);
      if (!paged_->Serve(list)) {
        for (const CutNode& node : cut.nodes) PageOf(node.node);  // stay when the list goes
        return cut;
      }
    }
    Give("a view does not settle");
  }

 private:
  std::unique_ptr<PagedDataset> paged_;
  int heights_ = 0;
  std::unordered_map<Quadcode, PagePin> pins_;
};

struct Count {
  int quadnodes = 0;
  int64_t triangles = 0;   // of quadnodes that are seen
  int64_t in_picture = 0;  // of those, the ones that are themselves
  double largest_px = 0;   // error

  void Add(const Count& other) {
    quadnodes += other.quadnodes;
    triangles += other.triangles;
    in_picture += other.in_picture;
    largest_px = std::max(largest_px, other.largest_px);
  }
};

bool InPicture(const std::array<glm::dvec3, 3>& ecef, const ViewMatrices& matrices) {
  std::array<glm::dvec4, 3> clip;
  for (size_t i = 0; i < 3; ++i) clip[i] = matrices.clip_from_ecef * glm::dvec4(ecef[i], 1);
  const auto all = [&](const auto& outside) { return std::all_of(clip.begin(), clip.end(), outside); };
  if (all([](const glm::dvec4& p) { return p.x > p.w; }) || all([](const glm::dvec4& p) { return p.x < -p.w; }) ||
      all([](const glm::dvec4& p) { return p.y > p.w; }) || all([](const glm::dvec4& p) { return p.y < -p.w; }) ||
      all([](const glm::dvec4& p) { return p.z > p.w; }))
    return false;
  const glm::dvec3 middle = (ecef[0] + ecef[1] + ecef[2]) / 3.0;
  double radius_m = 0;
  for (const glm::dvec3& corner : ecef) radius_m = std::max(radius_m, glm::distance(corner, middle));
  return !matrices.horizon.Hides({middle, radius_m});
}

// Of a surface whose quadnodes those are.
Count CountOf(std::span<const CutNode> nodes, const DisplayList& list, const ViewMatrices& matrices,
              GreedySearch& search) {
  Count count;
  std::vector<glm::dvec3> ecef;
  for (const ListVertex& vertex : *list.vertices) {
    const Frame& frame = list.frames[list.terrain_draws[vertex.draw()].frame];
    ecef.push_back(frame.ToEcef(glm::dvec3(vertex.x, vertex.y, vertex.z)));
  }
  std::vector<DrawnPosts> drawn(nodes.size(), DrawnPosts(kVerticesPerPage));
  for (const ListVertex& vertex : *list.vertices) drawn[vertex.draw()][vertex.post()] = true;
  for (size_t i = 0; i < nodes.size(); ++i) {
    if (!nodes[i].visible) continue;
    ++count.quadnodes;
    count.largest_px = std::max(count.largest_px, search.Largest_px(nodes[i].node, drawn[i]));
    const TerrainDraw& draw = list.terrain_draws[i];
    count.triangles += draw.index_count / 3;
    for (size_t at = draw.first_index; at < draw.first_index + draw.index_count; at += 3) {
      const std::array<glm::dvec3, 3> corners{ecef[list.indices[at]], ecef[list.indices[at + 1]],
                                              ecef[list.indices[at + 2]]};
      count.in_picture += InPicture(corners, matrices) ? 1 : 0;
    }
  }
  return count;
}

// Joins what was chosen, as every cut is joined: by pages whose delta values leave no other choice.
Count CountOf(std::span<const GreedySearch::Chosen> chosen, Pages& pages, const Sight& sight,
              const ViewMatrices& matrices, GreedySearch& search) {
  constexpr float kSurely_m = 1e6F;
  std::deque<TerrainPage> marked;
  std::vector<CutNode> nodes;
  for (const GreedySearch::Chosen& each : chosen) {
    TerrainPage& page = marked.emplace_back(pages.PageOf(each.node));
    for (size_t post = 0; post < kVerticesPerPage; ++post) page.deltas[post] = each.drawn[post] ? kSurely_m : 0.0F;
    CutNode& node = nodes.emplace_back();
    node.node = each.node;
    node.page = &page;
    node.visible = search.IsSeen(each.node);
  }
  SurfaceState state;
  DisplayList list;
  BuildSurface(nodes, sight, kBound_px, state, list);
  return CountOf(nodes, list, matrices, search);
}

struct Counts {
  Count drawn, same_cut, search;
};

Counts Measure(Pages& pages, const ViewParameters& view) {
  const Cut cut = pages.SettledCut(view);
  const ViewMatrices matrices = pages.MatricesFor(view);
  const Sight sight = SightOf(view, matrices.eye_ecef);
  GreedySearch search(pages, view, matrices, kBound_px);
  Counts counts;
  {
    SurfaceState state;
    DisplayList list;
    BuildSurface(cut.nodes, sight, view.error_px, state, list);
    counts.drawn = CountOf(cut.nodes, list, matrices, search);
  }
  std::vector<GreedySearch::Chosen> same;
  for (const CutNode& node : cut.nodes) same.push_back({node.node, search.Choose(node.node)});
  counts.same_cut = CountOf(same, pages, sight, matrices, search);
  counts.search = CountOf(search.Run(), pages, sight, matrices, search);
  return counts;
}

ViewParameters PoseOf(Poses& chance, int pose, const Dataset& dataset, ViewParameters view) {
  const Geodetic place = chance.PlaceOf(pose);
  const int layer = *dataset.FindLayer(LayerKind::kElevation);
  const Quadcode node = dataset.FinestContaining(layer, place.latitude_deg, place.longitude_deg);
  const auto page = dataset.ReadElevation(layer, node);
  if (!page.ok()) Give(page.message());
  const double ground_m = std::max(0.0, BilinearHeight(**page, node, place.latitude_deg, place.longitude_deg));
  const double height_m = ground_m + std::pow(10.0, chance.Uniform(2.3, 5.5));
  view.eye_ecef = ToEcef({place.latitude_deg, place.longitude_deg, height_m});
  view.ecef_from_camera = chance.AxesAt(place, -80, 0);
  ++view.number;
  fmt::print("pose {:2} at {:8.3f} {:9.3f}, {:7.0f} m over ground: ", pose, place.latitude_deg, place.longitude_deg,
             height_m - ground_m);
  return view;
}

double Ratio(int64_t drawn, int64_t searched) {
  return static_cast<double>(drawn) / static_cast<double>(std::max<int64_t>(searched, 1));
}

void Run(const std::string& path, int poses) {
  Pages pages(path);
  ViewParameters view;
  view.view = 1;
  view.error_px = kBound_px;
  view.image_layers = UsesOf(*LayersOf({}, pages.layers()));
  Poses chance(pages.dataset(), 2);
  const auto text = [](const Count& count) {
    return fmt::format("{} in picture of {} in all, {} quadnodes, {:.2f} px", count.in_picture, count.triangles,
                       count.quadnodes, count.largest_px);
  };
  Count drawn, searched;
  double largest = 0, sum = 0;
  for (int pose = 0; pose < poses; ++pose) {
    view = PoseOf(chance, pose, pages.dataset(), view);
    const Counts counts = Measure(pages, view);
    pages.Unpin();
    const double ratio = Ratio(counts.drawn.in_picture, counts.search.in_picture);
    fmt::print("drawn {}; same cut {}; search {}; ratio {:.2f}\n", text(counts.drawn), text(counts.same_cut),
               text(counts.search), ratio);
    std::fflush(stdout);
    largest = std::max(largest, ratio);
    sum += ratio;
    drawn.Add(counts.drawn);
    searched.Add(counts.search);
  }
  fmt::print("all poses: drawn {}; search {}\n", text(drawn), text(searched));
  fmt::print("{} poses, bound {} px: ratio in picture {:.3f}, mean {:.3f}, largest {:.3f}; in all {:.3f}\n", poses,
             kBound_px, Ratio(drawn.in_picture, searched.in_picture), sum / poses, largest,
             Ratio(drawn.triangles, searched.triangles));
}

}  // namespace
}  // namespace belvedere::figures

int main(int argc, char** argv) {
  const int poses = argc > 2 ? std::atoi(argv[2]) : 20;
  if (argc < 2 || argc > 3 || poses < 1) {
    fmt::print(stderr, "usage: {} DATASET [POSES]\n", argv[0]);
    return 2;
  }
  belvedere::figures::Run(argv[1], poses);
  return 0;
}
