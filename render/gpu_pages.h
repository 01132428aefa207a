// GpuPages: the pages that are on the GPU, in pools of slots of one size each: images in one array texture a
// format, and a table of models.
//
// Image slots are numbered through both formats, colour first: the slot of an ImageUse says which array holds it,
// whatever layers the view shows by now. Place and eviction follow SlotPool; a pool that is full of pages in use says
// once which setting would enlarge it. Uploads are plain sub-image and sub-buffer copies of ready-made levels, at a
// frame's start, when nothing is being drawn.
//
// Threads: the render thread.
#pragma once

#include "render/context.h"
#include "render/gl_objects.h"
#include "render/render_options.h"
#include "render/slot_pool.h"
#include "runtime/paging/layer_table.h"
#include "runtime/paging/shared_cache.h"
#include "runtime/scene/display_list.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace belvedere {

struct GpuModel {
  GlBuffer vertices;  // ModelVertex
  GlBuffer indices;   // uint32
  std::vector<ModelPage::Detail> details;
  std::array<glm::vec3, kModelJoints> pivots{};
};

class GpuPages {
 public:
  enum class Outcome { kPlaced, kAlreadyThere, kFull };

  GpuPages(const RenderOptions& options, const LayerTable& layers, const ContextFacts& facts);

  // Puts the page into a slot of its pool. REQUIRES: the key's data type is in the layer table: an image or a model.
  Outcome Upload(const PagePin& pin, uint64_t frame);
  // The list is drawn from now on: what it uses was used now.
  void Touch(const DisplayList& list, uint64_t frame);
  // Binds the image pools to texture units 0 and 1.
  void BindImages() const;

  // REQUIRES: slot is one of a pinned model page.
  const GpuModel& model(int slot) const { return models_[static_cast<size_t>(slot)]; }
  // Whether pages of the data type come to the GPU: of terrain, lists bring the vertices.
  bool IsKept(DataType type) const { return KindOf(type) >= PageKind::kColour; }
  PageKind KindOf(DataType type) const { return layers_.at(type).kind; }
  bool HoldsColour(DataType type) const { return KindOf(type) == PageKind::kColour; }
  // Whether the image slot is of the colour array, and which layer of its array it is.
  bool IsColour(int image_slot) const { return colour_.Owns(image_slot); }
  int ArrayLayer(int image_slot) const { return IsColour(image_slot) ? image_slot : image_slot - overlay_.first(); }
  uint64_t uploaded_bytes() const { return uploaded_bytes_; }
  const SlotPool& colour_pool() const { return colour_; }
  const SlotPool& overlay_pool() const { return overlay_; }

 private:
  struct Pool {
    SlotPool& slots;
    const char* setting;
  };
  Pool PoolOf(const PagePin& pin);
  void Copy(const PagePin& pin, int slot);
  void CopyImage(const ImagePage& page, GLuint texture, int layer);
  void CopyModel(const ModelPage& page, int slot);

  const LayerTable& layers_;
  SlotPool colour_, overlay_, model_slots_;
  GlTextureArray colour_texture_, overlay_texture_;
  std::vector<GpuModel> models_;
  std::array<bool, 3> warned_{};
  uint64_t uploaded_bytes_ = 0;
};

}  // namespace belvedere
