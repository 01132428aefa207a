// Page: an immutable unit of paged data, and the kinds of page that the run-time knows.
//
// A page is made once by a server, is never changed afterwards, and is shared by every view. Its key is a data type and
// a quadcode. Whoever uses a page pins it (shared_cache.h); its bytes count against the cache's budget.
//
// Rasters run row by row from the south-west corner, east fastest.
// Threads: read by any; `residency` alone changes, through its own atomics.
#pragma once

#include "runtime/earth/quadcode.h"
#include "runtime/paging/residency.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace belvedere {

// A layer of the dataset or one made by a read module; dense numbers from 0, given out at start (layer_table.h).
using DataType = uint16_t;

struct PageKey {
  DataType type = 0;
  Quadcode node;
  auto operator<=>(const PageKey&) const = default;
};

class Page {
 public:
  virtual ~Page() = default;
  // All memory that the page holds.
  virtual size_t bytes() const = 0;
  // Where the render thread keeps this page on the GPU, if it does. The render thread shares it, so that it learns when
  // the page is gone (it is then the only owner left) and can use the slot for another.
  const std::shared_ptr<Residency>& residency() const { return residency_; }

 private:
  std::shared_ptr<Residency> residency_ = std::make_shared<Residency>();
};

// ---- elevation: heights above the ellipsoid, as stored in the dataset ----------------------------------------------
// The 129 x 129 posts of a quadnode and an apron of two more on every side, so that normals and slopes at the border
// are those of the neighbour. Millimetres in int32: the border is shared bit for bit.
inline constexpr int kApron = 2;
inline constexpr int kElevationSide = kPosts + 2 * kApron;  // 133
inline constexpr double kMetresPerMillimetre = 1e-3;

// What finer pages add is kept for blocks of 8 x 8 cells, so that one cliff does not make the whole page look coarse.
inline constexpr int kErrorBlocks = 16;  // along each side
inline constexpr int kBlockCells = kCells / kErrorBlocks;
using ErrorBlocks = std::array<float, static_cast<size_t>(kErrorBlocks) * kErrorBlocks>;  // row by row

// Delta values in the logarithm: post i has greatest_m / 2^(steps[i] / kDeltaStepsPerOctave), or less; stored_deltas.h.
inline constexpr int kDeltaStepsPerOctave = 12;
struct StoredDeltas {
  float greatest_m = 0;
  std::vector<uint8_t> steps;  // kVerticesPerPage, or none
  bool operator==(const StoredDeltas&) const = default;
};

struct ElevationPage final : Page {
  std::vector<int32_t> heights_mm;  // kElevationSide^2
  float min_m = 0, max_m = 0;       // over this page's posts and all finer pages under it
  // No point of the finest pages under this one lies further, vertically, from this page's own full-resolution
  // triangles; 0 where nothing is finer. block_errors_m says it of each block, error_m of them all.
  ErrorBlocks block_errors_m{};
  float error_m = 0;
  // Delta values (TerrainPage::deltas) at an exaggeration of 1, made by the builder from the finest posts there are.
  // None where nothing is finer than the page: there its own posts say all.
  StoredDeltas deltas;

  // Post (column, row), each -kApron .. kPosts - 1 + kApron.
  int32_t at(int column, int row) const {
    return heights_mm[static_cast<size_t>((row + kApron) * kElevationSide + column + kApron)];
  }
  size_t bytes() const override {
    return sizeof(*this) + heights_mm.capacity() * sizeof(int32_t) + deltas.steps.capacity();
  }
};

// ---- images: colour from the dataset, or what a read module makes of heights ---------------------------------------
// kImageSide x kImageSide texels, of which the inner kImageInner x kImageInner cover the quadnode exactly; the gutter
// of kImageGutter texels around them repeats the neighbours, so that filtering at mip levels 0..2 crosses no seam.
inline constexpr int kImageSide = 256;
inline constexpr int kImageGutter = 4;
inline constexpr int kImageInner = kImageSide - 2 * kImageGutter;  // 248
inline constexpr int kImageMipLevels = 3;

enum class ImageFormat : uint8_t { kR8 = 1, kRGBA8 = 4 };  // value = bytes a texel

struct ImagePage final : Page {
  ImageFormat format = ImageFormat::kRGBA8;
  // Level 0, then 1, then 2, each half the side of the one before. sRGB colour, straight alpha.
  std::vector<uint8_t> texels;

  static constexpr size_t MipOffset(int level, ImageFormat format) {
    size_t texels_before = 0;
    for (int l = 0; l < level; ++l)
      texels_before += static_cast<size_t>(kImageSide >> l) * static_cast<size_t>(kImageSide >> l);
    return texels_before * static_cast<size_t>(format);
  }
  size_t bytes() const override { return sizeof(*this) + texels.capacity(); }
};

// ---- terrain: what the terrain server makes of heights --------------------------------------------------------------
struct TerrainVertex {
  float x, y, z;    // metres in the quadnode's coordinate frame (frame.h)
  uint32_t normal;  // outward normal in the same frame: octahedral, snorm16 x in the low half, y in the high half
};
inline glm::vec3 PlaceOf(const TerrainVertex& vertex) {
  return {vertex.x, vertex.y, vertex.z};
}
inline constexpr int kVerticesPerPage = kPosts * kPosts;
inline constexpr int kBisections = 2 * kCellsLog2;  // levels of bisection from the two root triangles to single posts

// A property of the ground, one or more bytes at each post of an elevation page: classes, or numbers in even steps, as
// the layer's record says (PropertyRecord in dataset.h).
inline constexpr int kMostPropertyChannels = 4;
struct PropertyPage final : Page {
  int channels = 1;             // 1 to kMostPropertyChannels
  std::vector<uint8_t> values;  // channel after channel, each kElevationSide^2, row by row from the south-west

  // Post (column, row), each -kApron .. kPosts - 1 + kApron.
  uint8_t at(int channel, int column, int row) const {
    constexpr size_t kSide = static_cast<size_t>(kElevationSide);
    return values[(static_cast<size_t>(channel) * kSide + static_cast<size_t>(row + kApron)) * kSide +
                  static_cast<size_t>(column + kApron)];
  }
  size_t bytes() const override { return sizeof(*this) + values.capacity(); }
};

struct TerrainPage final : Page {
  Quadcode node;
  std::vector<TerrainVertex> vertices;  // kVerticesPerPage
  // Delta value of each post: an upper bound, in metres, of the distance between the finest surface and the two
  // triangles that the post splits (bisection.h), if they are drawn whole; what finer pages add is part of it
  // (delta_values.h).
  std::vector<float> deltas;  // kVerticesPerPage
  // Every point of the triangles that a post of bisection level l splits lies within spread_m[l] of it.
  std::array<float, kBisections> spread_m{};
  float error_m = 0;  // what is left when every post of this page is drawn; 0 where the data end
  float min_height_m = 0, max_height_m = 0;
  glm::dvec3 center_ecef{};  // bounding sphere of the surface at every level under this node
  double radius_m = 0;

  size_t bytes() const override {
    return sizeof(*this) + vertices.capacity() * sizeof(TerrainVertex) + deltas.capacity() * sizeof(float);
  }
};

// ---- models: what the object server makes of a model file -----------------------------------------------------------
// What of a model moves by itself. A file names them: nodes "turret", "gun", "rotor", "tail_rotor", "propeller", "gear"
// and "hatch", with what hangs under them.
enum class ModelJoint : uint8_t {
  kNone,
  kTurret,     // turns about the body's z axis,
  kGun,        // rises about y, and turns with the turret
  kRotor,      // spins about z,
  kTailRotor,  // about y,
  kPropeller,  // about x
  kGear,       // retracts into its pivot
  kHatch,      // opens about y
};
inline constexpr size_t kModelJoints = 8;

struct ModelVertex {
  float x, y, z;  // metres in the body frame: x forward, y right, z down
  float normal_x, normal_y, normal_z;
  std::array<uint8_t, 3> colour;  // sRGB
  uint8_t joint;                  // ModelJoint
};

// Where something can be attached to a model. A file names them: nodes "station_640" and the like, with the numbers of
// SISO-REF-010: 512 and on under the fuselage, 640 the left wing, 768 the right, under 512 the model's own.
struct ModelStation {
  uint16_t number = 0;
  glm::vec3 place{};  // in the body frame
};

struct ModelPage final : Page {
  // One level of detail: a range of `indices`, 3 a triangle.
  struct Detail {
    uint32_t first_index = 0;
    uint32_t index_count = 0;
    float error_m = 0;  // how far its surface may lie from the finest one's
  };
  std::vector<ModelVertex> vertices;
  std::vector<uint32_t> indices;
  std::vector<Detail> details;                   // finest first; at least one
  std::array<glm::vec3, kModelJoints> pivots{};  // of each joint, in the body frame
  std::vector<ModelStation> stations;            // in the file's order
  float radius_m = 0;                            // of the sphere around the body's origin that holds it

  size_t bytes() const override {
    return sizeof(*this) + vertices.capacity() * sizeof(ModelVertex) + indices.capacity() * sizeof(uint32_t) +
           details.capacity() * sizeof(Detail) + stations.capacity() * sizeof(ModelStation);
  }
};

}  // namespace belvedere
