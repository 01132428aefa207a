#include "managers/cut.h"

#include "managers/ground_bounds.h"
#include "runtime/earth/ellipsoid.h"
#include "runtime/earth/post_grid.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <utility>

namespace belvedere {
namespace {

constexpr double kShareBesideMap =
    0.005;                              // likewise beside an orthographic picture, where nothing shrinks with distance
constexpr double kLeastStretch = 0.02;  // straight down is never quite straight down for all of a quadnode
constexpr double kNearest_m = 0.5;
constexpr float kRootPriority = 1e6F;  // roots first: without them nothing is drawn
constexpr double kLeastSlant = 0.03;
constexpr double kMetresPerDegree = 111'320.0;
constexpr float kGreatestPriority = 1e5F;

// Of the quadnode's sides on the ground, in degrees of a great circle.
double LongestSideDegrees(Quadcode node) {
  if (node.Doublings() == 0) return node.HeightDegrees();
  return std::max(node.HeightDegrees(), WidthOnGroundDegrees(node));
}

struct Measure {
  double error_scale = 0;       // see CutNode
  double greatest_stretch = 0;  // likewise
  double metre_px = 0;          // pixels that one metre across the line of sight spans, at the quadnode's nearest point
  double nearest_depth_m = 0;
  double texel_share = 1;     // of a texel's size that counts where the ground is seen at a slant
  double error_metre_px = 0;  // pixels that one metre of vertical error spans there, at most
  double share = 1;           // of what is measured counts: 1 in view, less beside it, 0 behind the horizon
};

class Selection {
 public:
  Selection(const ViewParameters& view, const ViewMatrices& matrices, const LayerTable& layers, DataType terrain,
            const CutLimits& limits, PageAccess& pages, std::span<const DataType> before)
      : view_(view),
        matrices_(matrices),
        layers_(layers),
        terrain_(terrain),
        limits_(limits),
        pages_(pages),
        before_(before),
        sight_(SightOf(view, matrices.eye_ecef)),
        eye_height_m_(ToGeodetic(matrices.eye_ecef).height_m) {
    const double tan_half = std::tan(0.5 * view.vertical_fov.value);
    half_picture_ = {tan_half * view.width_px / view.height_px, tan_half};
    if (!sight_.perspective) return;
    for (size_t side = 0; side < outwards_.size(); ++side) {
      const glm::dvec3& inward = sight_.inwards_ecef[side];
      const glm::dvec3 ahead = glm::normalize(sight_.forward_ecef - glm::dot(sight_.forward_ecef, inward) * inward);
      outwards_[side] = -std::sqrt(1.0 - kBesideGuard * kBesideGuard) * inward - kBesideGuard * ahead;
    }
  }

  Cut Run() {
    for (int tree = 0; tree < kTrees; ++tree) {
      const Quadcode node = Quadcode::Root(tree);
      if (pages_.Terrain(node) != nullptr) {
        Add(node);
      } else {
        cut_.waiting |= pages_.Want({terrain_, node}, kRootPriority);
        cut_.behind = true;
      }
    }
    // An Earth with holes is not shown: until the last root has come, there is none.
    if (cut_.waiting) return std::move(cut_);
    std::vector<size_t> roots(branches_.size());
    std::iota(roots.begin(), roots.end(), size_t{0});
    // The worst first, so that where a limit ends it, what is left is the least.
    while (!coarse_.empty() && drawn_ + awaited_ + 3 <= limits_.max_nodes) {
      std::pop_heap(coarse_.begin(), coarse_.end());
      const size_t branch = coarse_.back().branch;
      coarse_.pop_back();
      Refine(branch);
    }
    cut_.at_limit = !coarse_.empty();
    for (const Coarse& left : coarse_) cut_.behind |= branches_[left.branch].measure.share >= 1.0;
    Emit(roots);
    CountStepsBefore();
    return std::move(cut_);
  }

 private:
  // A quadnode that is drawn, or whose children are.
  struct Branch {
    Quadcode node;
    const TerrainPage* page = nullptr;
    Measure measure;
    double geometry_ratio = 0;  // what is left with all posts drawn, over the bound
    double ratio = 0;           // the greater of that and of texels
    double distance_m = 0;
    std::optional<size_t> first_child;  // of as many in a row as there are
  };
  struct Coarse {  // a branch that should be refined
    double ratio = 0;
    size_t branch = 0;
    bool operator<(const Coarse& other) const { return ratio < other.ratio; }
  };

  // REQUIRES: its terrain page is in memory.
  void Add(Quadcode node) {
    Branch branch;
    branch.node = node;
    branch.page = pages_.Terrain(node);
    branch.measure = MeasureOf(*branch.page);
    branch.geometry_ratio =
        branch.page->error_m * branch.measure.error_metre_px * branch.measure.share / view_.error_px;
    branch.ratio = std::max(branch.geometry_ratio, TextureRatio(node, branch.measure));
    branch.distance_m = glm::distance(branch.page->center_ecef, matrices_.eye_ecef);
    if (node.is_root()) branch.distance_m -= branch.page->radius_m;
    ++drawn_;
    const bool finer = node.level() < layers_.at(terrain_).max_level && layers_.at(terrain_).exists(node.Child(0));
    if (branch.ratio > 1.0 && finer) {
      coarse_.push_back({branch.ratio, branches_.size()});
      std::push_heap(coarse_.begin(), coarse_.end());
    }
    branches_.push_back(branch);
  }

  // Takes the children instead of the quadnode, if they all can be drawn.
  void Refine(size_t index) {
    const Branch parent = branches_[index];
    bool all = true, any_coming = false;
    const std::span<const int> children = parent.node.Children();
    for (const int which : children) {
      const Quadcode child = parent.node.Child(which);
      if (pages_.Terrain(child) != nullptr) continue;
      const bool coming = pages_.Want({terrain_, child}, std::min(static_cast<float>(parent.ratio), kGreatestPriority));
      cut_.waiting |= coming;
      cut_.behind |= parent.measure.share >= 1.0 && coming;
      all = false;
      any_coming |= coming;
    }
    if (any_coming) awaited_ += static_cast<int>(children.size()) - 1;
    if (!all) return;
    branches_[index].first_child = branches_.size();
    --drawn_;
    for (const int which : children) Add(parent.node.Child(which));
  }

  // Front to back, nested.
  void Emit(std::span<size_t> branches) {
    std::sort(branches.begin(), branches.end(),
              [&](size_t a, size_t b) { return branches_[a].distance_m < branches_[b].distance_m; });
    for (const size_t index : branches) {
      const Branch& branch = branches_[index];
      const auto begin = static_cast<uint32_t>(cut_.records.size());
      cut_.records.push_back({ListRecord::Kind::kCullBegin, static_cast<uint32_t>(cut_.volumes.size()), 0, 0});
      cut_.volumes.push_back({branch.page->center_ecef, branch.page->radius_m});
      if (const std::optional<size_t> first = branch.first_child) {
        std::array<size_t, 4> children{};
        const size_t count = branch.node.Children().size();
        std::iota(children.begin(), children.end(), *first);
        Emit(std::span(children).first(count));
      } else {
        Draw(branch);
      }
      cut_.records.push_back({ListRecord::Kind::kCullEnd, 0, 0, 0});
      cut_.records[begin].skip = static_cast<uint32_t>(cut_.records.size());
    }
  }

  void Draw(const Branch& branch) {
    const Measure& measure = branch.measure;
    CutNode drawn;
    drawn.node = branch.node;
    drawn.page = branch.page;
    drawn.error_scale = measure.error_scale * measure.share;
    drawn.greatest_stretch = measure.greatest_stretch;
    drawn.nearest_depth_m = measure.nearest_depth_m;
    drawn.finest = branch.geometry_ratio <= 1.0;
    drawn.visible = measure.share >= 1.0;
    for (size_t i = 0; i < std::min(view_.image_layers.size(), size_t{kMaxImageLayers}); ++i) {
      if (view_.image_layers[i].shown()) drawn.images[i] = ChooseImage(i, branch.node, measure);
    }
    if (drawn.visible && !drawn.finest) {
      drawn.left_over_px = static_cast<float>(branch.page->error_m * measure.error_metre_px);
      cut_.left_over_error_px = std::max(cut_.left_over_error_px, static_cast<double>(drawn.left_over_px));
    }
    cut_.records.push_back({ListRecord::Kind::kDrawTerrain, static_cast<uint32_t>(cut_.nodes.size()), 1, 0});
    cut_.nodes.push_back(drawn);
  }

  // Texel size over the bound, for the layers that have finer pages under the quadnode.
  double TextureRatio(Quadcode node, const Measure& measure) const {
    if (node.level() >= kMaxLevel) return 0;
    const Quadcode child = node.Child(0);
    const auto exists = [&](DataType type) {
      return child.level() <= layers_.at(type).max_level && layers_.at(type).exists(child);
    };
    bool finer = false;
    for (size_t i = 0; i < view_.image_layers.size() && !finer; ++i) {
      const DataType type = view_.image_layers[i].type;
      if (view_.image_layers[i].shown()) finer = exists(type) || (Before(i) != type && exists(Before(i)));
    }
    return finer ? TexelRatio(node, measure) : 0.0;
  }

  // The step that the layer shows where that of the view is not there yet.
  DataType Before(size_t layer) const {
    return layer < before_.size() ? before_[layer] : view_.image_layers[layer].type;
  }

  double TexelRatio(Quadcode node, const Measure& measure) const {
    const double texel_m = LongestSideDegrees(node) * kMetresPerDegree / kImageInner;
    return texel_m * measure.metre_px * measure.texel_share * measure.share / view_.texel_px;
  }

  ImageUse ChooseImage(size_t layer, Quadcode node, const Measure& measure) {
    // The coarsest page whose texels are small enough is as good as any finer one.
    int level = node.level();
    while (level > 0 && TexelRatio(node.Ancestor(level - 1), measure) <= 1.0) --level;
    const DataType type = view_.image_layers[layer].type;
    const std::optional<Quadcode> best = layers_.DeepestExisting(type, node.Ancestor(level));
    const bool behind = cut_.behind;
    const ImageUse use = best ? WantImage({type, *best}, node, measure) : ImageUse{};
    if (Before(layer) == type || (use.slot >= 0 && use.source == *best)) return use;
    const int enough = use.slot >= 0 ? use.source.level() : -1;
    const ImageUse before = FinestBefore(Before(layer), node, level, enough);
    if (before.slot < 0) return use;
    if (!best || before.source.level() >= best->level()) cut_.behind = behind;  // another time, but no coarser
    shown_before_.emplace_back(layer, before.source);
    return before;
  }

  void CountStepsBefore() {
    std::sort(shown_before_.begin(), shown_before_.end());
    const auto end = std::unique(shown_before_.begin(), shown_before_.end());
    std::for_each(shown_before_.begin(), end, [&](const auto& image) { ++cut_.of_step_before[image.first]; });
  }

  // The finest image of a step that is on the GPU, of those over `coarser` and up to `level`.
  ImageUse FinestBefore(DataType type, Quadcode node, int level, int coarser) {
    const std::optional<Quadcode> best = layers_.DeepestExisting(type, node.Ancestor(level));
    for (int at = best ? best->level() : coarser; at > coarser; --at) {
      const Quadcode source = node.Ancestor(at);
      if (const std::optional<int> slot = pages_.Slot({type, source})) return SubRectangle(*slot, type, source, node);
    }
    return {};
  }

  // The image that is wanted, or the finest of its ancestors that is on the GPU.
  ImageUse WantImage(const PageKey& wanted, Quadcode node, const Measure& measure) {
    const auto [type, best] = wanted;
    for (Quadcode source = best;; source = source.Parent()) {
      if (const std::optional<int> slot = pages_.Slot({type, source})) return SubRectangle(*slot, type, source, node);
      const double ratio = TexelRatio(source, measure) * std::ldexp(1.0, best.level() - source.level());
      const float priority = source.is_root() ? 0.5F * kRootPriority : static_cast<float>(std::min(ratio, 1e4));
      if (source == best || source.is_root()) {
        const bool coming = pages_.Want({type, source}, priority);
        cut_.waiting |= coming;
        cut_.behind |= coming && measure.share >= 1.0;
      }
      if (source.is_root()) return {};
    }
  }

  static ImageUse SubRectangle(int slot, DataType type, Quadcode source, Quadcode node) {
    return PartOf({.slot = slot, .source = source, .type = type}, source, node);
  }

  // All of it lies beyond one side of the picture, and by kBesideGuard at least: it may be turned to before the next
  // list.
  bool IsBeside(const GroundBounds& bounds) const {
    return std::any_of(outwards_.begin(), outwards_.end(),
                       [&](const glm::dvec3& outward) { return bounds.LeastAlong(matrices_.eye_ecef, outward) > 0; });
  }

  Measure MeasureOf(const TerrainPage& page) const {
    const BoundingSphere sphere{page.center_ecef, page.radius_m};
    std::optional<GroundBounds> bounds;
    if (sight_.perspective && GroundBounds::AreWorthTheirMaking(page.node)) bounds.emplace(page);
    Measure measure;
    if (matrices_.horizon.Hides(sphere)) {
      measure.share = 0;
    } else if (matrices_.frustum.Hides(sphere) || (bounds && IsBeside(*bounds))) {
      measure.share = sight_.perspective ? kShareBesidePicture : kShareBesideMap;
    }
    const glm::dvec3 center = (page.center_ecef - matrices_.eye_ecef) * view_.ecef_from_camera;  // camera axes
    const glm::dvec3 up = glm::normalize(page.center_ecef) * view_.ecef_from_camera;
    if (!sight_.perspective) {
      measure.metre_px = matrices_.pixels_per_metre;
      measure.error_scale = matrices_.pixels_per_metre * std::min(1.0, std::hypot(up.x, up.y) + TiltOver(page));
      measure.error_metre_px = measure.error_scale;
      return measure;
    }
    double nearest = std::max({glm::length(center) - page.radius_m, eye_height_m_ - page.max_height_m, kNearest_m});
    double nearest_depth = -center.z - page.radius_m;
    if (bounds) {
      nearest = std::max(nearest, bounds->DistanceTo(matrices_.eye_ecef));
      nearest_depth = std::max(nearest_depth, bounds->LeastAlong(matrices_.eye_ecef, sight_.forward_ecef));
    }
    nearest_depth = std::max(nearest_depth, sight_.cos_corner * nearest);
    measure.nearest_depth_m = nearest_depth;
    measure.metre_px = matrices_.pixels_per_radian / nearest_depth;
    measure.greatest_stretch = GreatestStretch(page, center, up);
    measure.error_scale = matrices_.pixels_per_radian * measure.greatest_stretch;
    measure.error_metre_px = measure.error_scale / nearest_depth;
    measure.texel_share = std::sqrt(GreatestSlant(page, nearest));
    return measure;
  }

  // Greatest sine of the angle under which the ground of the quadnode is seen, its slopes reckoned from its relief. A
  // texel seen at a slant is short one way; filtering makes the picture no sharper than the mean of its two sides, the
  // square root of this.
  double GreatestSlant(const TerrainPage& page, double nearest_m) const {
    const double relief_m = page.max_height_m - page.min_height_m;
    const double size_m = page.node.HeightDegrees() * kMetresPerDegree;
    return std::clamp((eye_height_m_ - page.min_height_m) / nearest_m + relief_m / size_m, kLeastSlant, 1.0);
  }

  // How far the vertical turns from the quadnode's middle to its rim, radians; and from geocentric to geodetic.
  static double TiltOver(const TerrainPage& page) { return std::min(1.0, page.radius_m / kPolarRadius_m) + 0.0034; }

  // g of cut.h, at most, over what the quadnode covers of the picture. center, up: in camera axes.
  double GreatestStretch(const TerrainPage& page, const glm::dvec3& center, const glm::dvec3& up) const {
    glm::dvec2 low(-half_picture_);
    glm::dvec2 high(half_picture_);
    const double depth = -center.z;
    if (depth > page.radius_m) {
      // The sphere's points lie within this of its centre, on the plane at depth 1.
      const glm::dvec2 middle = glm::dvec2(center) / depth;
      const double spread = page.radius_m * std::sqrt(1.0 + glm::dot(middle, middle)) / (depth - page.radius_m);
      low = glm::clamp(middle - spread, low, high);
      high = glm::clamp(middle + spread, low, high);
    }
    double greatest = 0;
    for (const glm::dvec2 corner : {low, glm::dvec2(low.x, high.y), glm::dvec2(high.x, low.y), high}) {
      // In camera axes z points backward: what lies ahead at depth 1 is (x, y, -1).
      greatest = std::max(greatest, glm::length(glm::dvec2(up) + corner * up.z));
    }
    return std::max(kLeastStretch, greatest + TiltOver(page) * (1.0 + glm::length(half_picture_)));
  }

  const ViewParameters& view_;
  const ViewMatrices& matrices_;
  const LayerTable& layers_;
  const DataType terrain_;
  const CutLimits& limits_;
  PageAccess& pages_;
  const std::span<const DataType> before_;
  const Sight sight_;
  std::array<glm::dvec3, 4> outwards_{};  // away from the sides of a picture that is wider by kBesideGuard
  const double eye_height_m_;
  glm::dvec2 half_picture_{};     // of the picture's half sides on the plane at depth 1
  std::vector<Branch> branches_;  // the roots first
  std::vector<Coarse> coarse_;    // a heap, the worst on top
  int drawn_ = 0;                 // branches without children
  int awaited_ = 0;               // by which drawn_ will grow when the pages wished for have come
  std::vector<std::pair<size_t, Quadcode>> shown_before_;  // images of the step before, of which layer
  Cut cut_;
};

}  // namespace

ImageUse PartOf(const ImageUse& image, Quadcode node, Quadcode descendant) {
  const GridPoint from = node.SouthWest(), to = descendant.SouthWest();
  const auto share = [](uint32_t of, uint32_t whole) { return static_cast<float>(of) / static_cast<float>(whole); };
  ImageUse part = image;
  part.offset_u += image.scale_u * share(to.x - from.x, node.GridWidth());
  part.offset_v += image.scale_v * share(to.y - from.y, node.GridHeight());
  part.scale_u *= share(descendant.GridWidth(), node.GridWidth());
  part.scale_v *= share(descendant.GridHeight(), node.GridHeight());
  return part;
}

Sight SightOf(const ViewParameters& view, const glm::dvec3& eye_ecef) {
  const double tan_half = std::tan(0.5 * view.vertical_fov.value);
  const double tan_half_width = tan_half * view.width_px / view.height_px;
  Sight sight;
  sight.eye_ecef = eye_ecef;
  sight.forward_ecef = -view.ecef_from_camera[2];
  sight.cos_corner = 1.0 / std::sqrt(1.0 + tan_half * tan_half + tan_half_width * tan_half_width);
  sight.perspective = view.projection == Projection::kPerspective;
  if (!sight.perspective) return sight;
  const std::array<glm::dvec3, 4> inwards{glm::dvec3(1, 0, -tan_half_width), glm::dvec3(-1, 0, -tan_half_width),
                                          glm::dvec3(0, 1, -tan_half), glm::dvec3(0, -1, -tan_half)};
  for (size_t side = 0; side < inwards.size(); ++side)
    sight.inwards_ecef[side] = view.ecef_from_camera * glm::normalize(inwards[side]);
  return sight;
}

Cut SelectCut(const ViewParameters& view, const ViewMatrices& matrices, const LayerTable& layers, DataType terrain,
              const CutLimits& limits, PageAccess& pages, std::span<const DataType> before) {
  return Selection(view, matrices, layers, terrain, limits, pages, before).Run();
}

}  // namespace belvedere
