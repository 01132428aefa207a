// Cut: the first stage of terrain selection. Chooses the quadnodes whose own posts and images are fine enough, walking
// the 32 quadtrees from their roots.
//
// A quadnode is replaced by its children when either is true within the view:
//   geometry: what is left with every post of its page drawn, error_m, is more than error_px pixels;
//   texture:  a texel of its own image would span more than texel_px pixels, and the layer has finer pages there;
// and all children can be drawn: their terrain pages are in memory. Until then the quadnode itself is drawn and
// the children are asked for. So a cut always covers the whole Earth, exactly once. The worst quadnode is replaced
// first: where CutLimits end it, what is left over is the least that can be.
//
// Screen-space error. A point displaced by e along the local vertical u moves on the picture by exactly
//     e * pixels_per_radian * g / z,   g = |(u_x, u_y) - (x, y) u_z / z|
// with x, y, z its place and u_x, u_y, u_z the vertical in camera axes, z along the line of view. g is convex in (x, y)
// / z, so its greatest value over a quadnode is at a corner of what the quadnode covers of the picture; each quadnode
// takes that once, as error_scale. z, and g where it is less, are taken anew for every post (post_selection.h). What is
// out of sight, quadnodes and triangles within them (likewise), keeps a share of its error, so that turning the head
// does not start from nothing. A quadnode is out of sight where its sphere is, or where the box around its ground lies
// beyond one side of a picture that is wider by kBesideGuard: spheres say little of quadnodes that are long or, by a
// pole, pointed (ground_bounds.h).
//
// Steps. Where a layer has gone on to another of its steps (step_change.h), a quadnode shows the step before until the
// image of the new one that suits it is on the GPU, or one as fine as that of the step before: nothing coarser is
// flashed in. Pages of the step before are shown while they are there and never asked for.
//
// Units: metres, pixels, ECEF. Threads: pure; PageAccess is called on the caller's thread.
#pragma once

#include "runtime/paging/layer_table.h"
#include "runtime/scene/display_list.h"
#include "runtime/scene/view_parameters.h"

#include <array>
#include <optional>
#include <span>
#include <vector>

namespace belvedere {

inline constexpr double kShareBesidePicture = 0.08;  // of the error that counts beside a perspective picture
inline constexpr double kBesideGuard = 0.05;         // sine of an angle: nearer to the picture nothing is beside it

// What the cut needs to know of pages; whatever it is given stays valid as long as the list that is being built.
class PageAccess {
 public:
  virtual ~PageAccess() = default;
  // nullptr when it is not in memory.
  virtual const TerrainPage* Terrain(Quadcode node) = 0;
  // The image page's slot on the GPU; nullopt when it is not there.
  virtual std::optional<int> Slot(const PageKey& key) = 0;
  // The page should come, to memory and, an image, to the GPU. False when it never will (it failed).
  virtual bool Want(const PageKey& key, float priority) = 0;
};

// From where and which way errors are seen.
struct Sight {
  glm::dvec3 eye_ecef{};
  glm::dvec3 forward_ecef{};
  double cos_corner = 1;  // cosine of the angle from the line of view to a corner of the picture
  bool perspective = true;
  // Unit normals, inwards, of the planes through the eye and a side of the picture; zero where they are not known.
  std::array<glm::dvec3, 4> inwards_ecef{};
};
Sight SightOf(const ViewParameters& view, const glm::dvec3& eye_ecef);

struct CutNode {
  Quadcode node;
  const TerrainPage* page = nullptr;
  std::array<ImageUse, kMaxImageLayers> images{};
  // What images are blended in over, and until when (image_fade.h).
  std::array<ImageUse, kFadingLayers> from{};
  std::array<double, kFadingLayers> fade_until_s{};
  // Screen-space error of e metres at depth z: perspective e * error_scale / z, orthographic e * error_scale.
  double error_scale = 0;
  double greatest_stretch = 0;  // g in error_scale; 0: none, error_scale is for every post, as in an orthographic view
  double nearest_depth_m = 0;   // no point of the quadnode is nearer to the eye along the line of view
  bool finest = true;           // page->error_m is within the bound: drawing all posts keeps it
  float left_over_px = 0;       // error of what page->error_m leaves, where not `finest`
  bool visible = true;          // in the frustum and before the horizon
};

// The part of an image, which lies under a quadnode, under one of its descendants or itself.
ImageUse PartOf(const ImageUse& image, Quadcode node, Quadcode descendant);

struct CutLimits {
  int max_nodes = 8000;  // quadnodes in a cut; more are not refined
};

struct Cut {
  std::vector<CutNode> nodes;  // front to back; nodes[i] is drawn by the record with index i
  std::vector<ListRecord> records;
  std::vector<BoundingSphere> volumes;
  bool behind = false;                                // a visible quadnode is coarser than the bounds ask
  bool waiting = false;                               // a page was wanted that can still come
  bool at_limit = false;                              // CutLimits::max_nodes kept quadnodes coarse
  double left_over_error_px = 0;                      // largest error left by visible quadnodes that are not `finest`
  std::array<int, kMaxImageLayers> of_step_before{};  // images of the step before that are shown, of each layer
};

// terrain: the data type of terrain pages. Images are chosen for view.image_layers, whose types are those of the steps
// that are to be shown; before: of each layer the step before, or the same type.
Cut SelectCut(const ViewParameters& view, const ViewMatrices& matrices, const LayerTable& layers, DataType terrain,
              const CutLimits& limits, PageAccess& pages, std::span<const DataType> before = {});

}  // namespace belvedere
