#include "render/gpu_pages.h"

#include "runtime/base/log.h"
#include "runtime/base/status.h"

#include <algorithm>

namespace belvedere {
namespace {

GlTextureArray MakeImageArray(GLenum format, int slots, const ContextFacts& facts) {
  GlTextureArray texture = GlTextureArray::Make();
  glTextureStorage3D(texture.get(), kImageMipLevels, format, kImageSide, kImageSide, slots);
  // Blending two levels costs a software renderer half a frame; one level looks the same at the bound on texel size.
  glTextureParameteri(texture.get(), GL_TEXTURE_MIN_FILTER,
                      facts.software ? GL_LINEAR_MIPMAP_NEAREST : GL_LINEAR_MIPMAP_LINEAR);
  glTextureParameteri(texture.get(), GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTextureParameteri(texture.get(), GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTextureParameteri(texture.get(), GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  glTextureParameteri(texture.get(), GL_TEXTURE_MAX_LEVEL, kImageMipLevels - 1);
  if (facts.max_anisotropy > 1) {
    glTextureParameterf(texture.get(), GL_TEXTURE_MAX_ANISOTROPY_EXT, std::min(facts.max_anisotropy, 8.0F));
  }
  return texture;
}

}  // namespace

GpuPages::GpuPages(const RenderOptions& options, const LayerTable& layers, const ContextFacts& facts)
    : layers_(layers),
      colour_(options.colour_slots),
      overlay_(options.overlay_slots, options.colour_slots),
      model_slots_(options.model_slots),
      colour_texture_(MakeImageArray(GL_RGBA8, options.colour_slots, facts)),
      overlay_texture_(MakeImageArray(GL_R8, options.overlay_slots, facts)),
      models_(static_cast<size_t>(options.model_slots)) {}

GpuPages::Pool GpuPages::PoolOf(const PagePin& pin) {
  switch (KindOf(pin.key().type)) {
    case PageKind::kColour: return {colour_, "colour_slots"};
    case PageKind::kOverlay: return {overlay_, "overlay_slots"};
    case PageKind::kModel: return {model_slots_, "model_slots"};
    case PageKind::kElevation:
    case PageKind::kTerrain: break;
  }
  BELVEDERE_CHECK(IsKept(pin.key().type));  // nobody may ask for what is not kept here
  return {colour_, ""};
}

GpuPages::Outcome GpuPages::Upload(const PagePin& pin, uint64_t frame) {
  if (pin.page().residency()->on_gpu()) return Outcome::kAlreadyThere;
  const Pool pool = PoolOf(pin);
  const std::optional<int> slot = pool.slots.Take(frame);
  if (!slot) {
    const auto which = static_cast<size_t>(KindOf(pin.key().type)) - static_cast<size_t>(PageKind::kColour);
    if (!warned_.at(which)) {
      LogWarning("render: all {} slots are in use, finer pages wait; raise {} in the station's [render]",
                 pool.slots.size(), pool.setting);
    }
    warned_.at(which) = true;
    return Outcome::kFull;
  }
  Copy(pin, *slot);
  pool.slots.Fill(*slot, pin.page().residency(), frame);
  return Outcome::kPlaced;
}

void GpuPages::Copy(const PagePin& pin, int slot) {
  switch (KindOf(pin.key().type)) {
    case PageKind::kColour:
      BELVEDERE_CHECK(pin.as<ImagePage>().format == ImageFormat::kRGBA8);
      CopyImage(pin.as<ImagePage>(), colour_texture_.get(), slot);
      return;
    case PageKind::kOverlay:
      BELVEDERE_CHECK(pin.as<ImagePage>().format == ImageFormat::kR8);
      CopyImage(pin.as<ImagePage>(), overlay_texture_.get(), slot - overlay_.first());
      return;
    case PageKind::kModel: CopyModel(pin.as<ModelPage>(), slot); return;
    case PageKind::kElevation:
    case PageKind::kTerrain: return;
  }
}

void GpuPages::CopyImage(const ImagePage& page, GLuint texture, int layer) {
  BELVEDERE_CHECK(page.texels.size() >= ImagePage::MipOffset(kImageMipLevels, page.format));
  const GLenum format = page.format == ImageFormat::kRGBA8 ? GL_RGBA : GL_RED;
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  for (int level = 0; level < kImageMipLevels; ++level) {
    glTextureSubImage3D(texture, level, 0, 0, layer, kImageSide >> level, kImageSide >> level, 1, format,
                        GL_UNSIGNED_BYTE, page.texels.data() + ImagePage::MipOffset(level, page.format));
  }
  uploaded_bytes_ += ImagePage::MipOffset(kImageMipLevels, page.format);
}

void GpuPages::CopyModel(const ModelPage& page, int slot) {
  GpuModel model;
  model.vertices = GlBuffer::Make();
  model.indices = GlBuffer::Make();
  model.details = page.details;
  model.pivots = page.pivots;
  const size_t vertex_bytes = page.vertices.size() * sizeof(ModelVertex);
  const size_t index_bytes = page.indices.size() * sizeof(uint32_t);
  glNamedBufferData(model.vertices.get(), static_cast<GLsizeiptr>(vertex_bytes), page.vertices.data(), GL_STATIC_DRAW);
  glNamedBufferData(model.indices.get(), static_cast<GLsizeiptr>(index_bytes), page.indices.data(), GL_STATIC_DRAW);
  uploaded_bytes_ += vertex_bytes + index_bytes;
  models_[static_cast<size_t>(slot)] = std::move(model);
}

void GpuPages::Touch(const DisplayList& list, uint64_t frame) {
  for (const PagePin& pin : list.page_pins) {
    if (!IsKept(pin.key().type)) continue;
    Residency& residency = *pin.page().residency();
    const std::optional<int> slot = residency.TryPin();
    if (!slot) continue;
    PoolOf(pin).slots.Touch(*slot, frame);
    residency.Unpin();
  }
}

void GpuPages::BindImages() const {
  glBindTextureUnit(0, colour_texture_.get());
  glBindTextureUnit(1, overlay_texture_.get());
}

}  // namespace belvedere
