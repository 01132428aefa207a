// DisplayList: all that the render thread needs to draw one manager's part of one view, as plain records.
//
// A manager builds a list, publishes it through its triple buffer and does not touch it again until the buffer hands
// the memory back. The render thread walks the records in order; a cull-begin whose volume is hidden jumps past its
// cull-end. Records:
//
//   kCullBegin      index -> volumes; skip = record to go on with when hidden (one past the matching kCullEnd)
//   kCullEnd
//   kDrawTerrain    index -> terrain_draws
//   kDrawInstances  index -> instances [index, index + count)
//
// Terrain vertices are those of the drawn posts alone, quadnode after quadnode. Indices number them through the whole
// list: triangles of one quadnode may use vertices of its neighbours, and a vertex that several quadnodes share is the
// same number in all of them. That is what makes the surface watertight: shared edges are shared numbers.
//
// A vertex may start away from its place, where the list before had the surface, and goes there: t seconds after
// time_s it is rise_m * (1 - t / rise_s) over it, rise_s being that of its quadnode, and from rise_s on not at all.
//
// The manager may keep the vertices of a list, to start the next list's from them; nobody changes them while two have
// them.
//
// Everything that a list names is pinned by it until it is cleared: pages in the cache (page_pins), slots on the GPU
// (gpu_pins). `uploads` are the images that the manager would draw if they were on the GPU, most wanted first.
//
// Frames: volumes and instances in ECEF, metres, double; times in clock seconds.
// Threads: built by one manager, read by the render thread.
#pragma once

#include "runtime/base/view_id.h"
#include "runtime/earth/frame.h"
#include "runtime/earth/visibility.h"
#include "runtime/paging/page.h"
#include "runtime/paging/shared_cache.h"
#include "runtime/scene/label_box.h"

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace belvedere {

inline constexpr int kMaxImageLayers = 6;   // drawn over each other in one pass
inline constexpr size_t kFadingLayers = 2;  // the lowest ones, whose images are blended in

struct ListRecord {
  enum class Kind : uint8_t { kCullBegin, kCullEnd, kDrawTerrain, kDrawInstances };
  Kind kind = Kind::kCullEnd;
  uint32_t index = 0;
  uint32_t count = 0;
  uint32_t skip = 0;
};

// An image page under a quadnode: the page's own or an ancestor's, of which it covers a sub-rectangle.
// Texture coordinate = offset + scale * (position within the quadnode, 0..1 from its south-west corner).
struct ImageUse {
  int32_t slot = -1;  // -1: no image, draw as neutral
  float offset_u = 0, offset_v = 0;
  float scale_u = 1, scale_v = 1;
  Quadcode source;    // of the page
  DataType type = 0;  // of the page
};

struct ListVertex {
  float x = 0, y = 0, z = 0;  // metres in the frame of its quadnode
  uint32_t normal = 0;        // as in TerrainVertex
  uint32_t place = 0;         // the draw of its quadnode, and its post in it
  float rise_m = 0;           // upwards from its place, at time_s

  static constexpr uint32_t kPostBits = 15;
  static constexpr uint32_t kPostMask = (1U << kPostBits) - 1U;
  static constexpr uint32_t PlaceOf(uint32_t draw, uint32_t post) { return draw << kPostBits | post; }
  uint32_t draw() const { return place >> kPostBits; }
  uint32_t post() const { return place & kPostMask; }
};
static_assert(kVerticesPerPage < 1 << ListVertex::kPostBits);

struct TerrainDraw {
  Quadcode node;
  uint32_t frame = 0;  // index -> frames
  float rise_s = 0;    // for how long its vertices rise or sink; 0: they do not
  float error_px = 0;  // largest error that it leaves on the screen
  uint32_t first_index = 0;
  uint32_t index_count = 0;  // 3 a triangle
  // What the lowest images are blended in over, and for how long still at time_s; 0: they are there.
  std::array<ImageUse, kFadingLayers> from{};
  std::array<float, kFadingLayers> fade_s{};
  std::array<ImageUse, kMaxImageLayers> images{};  // as ViewParameters::image_layers has them
};

struct ObjectLook {
  int32_t model_slot = -1;                            // GPU slot of the model page; -1: symbol only
  uint8_t detail = 0;                                 // level of detail of the model, 0 the finest
  uint8_t symbol = 0;                                 // SymbolShape
  uint8_t frame = 0;                                  // SymbolShape around the symbol; none for kNone
  std::array<uint8_t, 4> colour{255, 255, 255, 255};  // force colour of symbol and label
  float scale = 1;
  float shade = 1;  // of the model's colours: darker where it is damaged
};

enum class SymbolShape : uint8_t {
  kNone,
  kAir,
  kGround,
  kSurface,
  kSubsurface,
  kOther,
  kFrameFriend,  // frames in the manner of APP-6: rectangle, diamond, square, quatrefoil
  kFrameHostile,
  kFrameNeutral,
  kFrameUnknown,
};
inline constexpr size_t kSymbolShapes = 10;

// How the joints of a model stand (ModelJoint in page.h).
struct JointPose {
  float turret_rad = 0;  // clockwise from above
  float gun_rad = 0;     // upwards
  float spin_rad = 0;    // of rotors and propellers
  float open = 1;        // gear down, hatch shut: 1; gear up, hatch open: 0
};

// One moving object. The render thread moves it on from `time_s` to its own frame's time, as it does the eye.
struct ObjectInstance {
  glm::dvec3 position_ecef{};
  glm::dvec3 velocity_mps{};
  glm::dmat3 ecef_from_body{1.0};      // columns: body x forward, y right, z down
  glm::dvec3 angular_velocity_body{};  // radians/s
  double radius_m = 0;
  ObjectLook look;
  JointPose joints;
  float spin_radps = 0;  // how fast spin_rad goes on
  uint32_t label = 0;    // index -> labels, 0 none
  uint64_t object = 0;   // ObjectId, for picking and for tests
};

// Smoke, fire, light, trails: soft shapes that face the eye, from one point to another or round about one.
struct EffectInstance {
  enum class Shape : uint8_t {
    kPuff,  // lit by day and hazy far off
    kGlow,  // light, added to what is behind it
    kLine,  // as kPuff with a firm edge, and not lit
    kDisc,  // flat on the ground at from_ecef, facing to_ecef
  };
  glm::dvec3 from_ecef{}, to_ecef{};                                                      // the same: round
  glm::dvec3 velocity_mps{};                                                              // of both
  float from_m = 1, to_m = 1;                                                             // radius at each
  float least_px = 0;                                                                     // is drawn no thinner
  std::array<uint8_t, 4> from_colour{255, 255, 255, 255}, to_colour{255, 255, 255, 255};  // straight alpha
  Shape shape = Shape::kPuff;
};
inline constexpr size_t kMostEffects = 4096;  // a view

// The data block of an object: lines of text, and the side on which it stands (label_box.h).
struct ObjectLabel {
  std::string text;
  LabelSide side = LabelSide::kRight;
};

// How many pages of a layer a list has looked for, by where they are.
struct LayerPages {
  std::string layer;
  uint32_t on_gpu = 0;     // images
  uint32_t in_memory = 0;  // and not on the GPU, where terrain never is
  uint32_t asked = 0;      // waiting for their server or being read
  uint32_t failed = 0;
};

struct DisplayList {
  ViewId view = 0;
  uint64_t view_number = 0;  // ViewParameters::number it was built for
  uint64_t number = 0;       // grows with every list of that manager
  double time_s = 0;         // clock time for which instances and rises are given

  std::vector<ListRecord> records;
  std::vector<BoundingSphere> volumes;
  std::vector<Frame> frames;
  std::shared_ptr<std::vector<ListVertex>> vertices = std::make_shared<std::vector<ListVertex>>();
  std::vector<uint32_t> indices;
  std::vector<TerrainDraw> terrain_draws;
  std::vector<ObjectInstance> instances;
  std::vector<EffectInstance> effects;  // kMostEffects at most
  std::vector<ObjectLabel> labels;      // labels[0] is empty; no two of them overlap

  std::vector<LayerPages> layer_pages;

  std::vector<PagePin> page_pins;
  std::vector<Residency*> gpu_pins;  // of pages in page_pins; unpinned by Clear
  std::vector<PagePin> uploads;

  struct Statistics {
    uint32_t triangles = 0;
    uint32_t nodes = 0;
    double held_error_px = 0;      // the bound that the list keeps: the one asked, or looser for a frame-time target
    double achieved_error_px = 0;  // largest screen-space error that the list leaves within the view
    uint32_t pages_waiting = 0;    // pages wished for and not yet drawn
    bool behind = false;           // some visible quadnode is coarser than the bound asks
    bool settled = false;          // nothing more will come for these view parameters
    double rises_until_s = 0;      // clock time from which on all vertices and images are in their places
    double height_above_ground_m = 0;  // of the eye, over the finest resident surface under it
    double build_ms = 0;
  } statistics;

  // Ready to be filled anew; keeps its memory.
  void Clear();
  DisplayList() = default;
  ~DisplayList() { Clear(); }
  DisplayList(const DisplayList&) = delete;
  DisplayList& operator=(const DisplayList&) = delete;
};

}  // namespace belvedere
