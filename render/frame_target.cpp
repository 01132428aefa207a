#include "render/frame_target.h"

#include "runtime/base/status.h"

#include <algorithm>
#include <array>

namespace belvedere {
namespace {

// OpenGL's first row is the lowest.
template <typename T>
void FlipRows(std::vector<T>& pixels, size_t row_length) {
  const size_t rows = pixels.size() / row_length;
  for (size_t row = 0; row < rows / 2; ++row) {
    const auto low = pixels.begin() + static_cast<std::ptrdiff_t>(row * row_length);
    const auto high = pixels.begin() + static_cast<std::ptrdiff_t>((rows - 1 - row) * row_length);
    std::swap_ranges(low, low + static_cast<std::ptrdiff_t>(row_length), high);
  }
}

}  // namespace

void FrameTarget::Resize(int width, int height) {
  if (width == width_ && height == height_) return;
  width_ = width;
  height_ = height;
  colour_ = GlTexture::Make();
  glTextureStorage2D(colour_.get(), 1, GL_RGBA8, width, height);
  glTextureParameteri(colour_.get(), GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  depth_ = GlRenderbuffer::Make();
  glNamedRenderbufferStorage(depth_.get(), GL_DEPTH_COMPONENT32F, width, height);
  framebuffer_ = GlFramebuffer::Make();
  glNamedFramebufferTexture(framebuffer_.get(), GL_COLOR_ATTACHMENT0, colour_.get(), 0);
  glNamedFramebufferRenderbuffer(framebuffer_.get(), GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth_.get());
  BELVEDERE_CHECK(glCheckNamedFramebufferStatus(framebuffer_.get(), GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE);
  if (samples_ == 0) return;
  many_colour_ = GlRenderbuffer::Make();
  glNamedRenderbufferStorageMultisample(many_colour_.get(), samples_, GL_RGBA8, width, height);
  many_depth_ = GlRenderbuffer::Make();
  glNamedRenderbufferStorageMultisample(many_depth_.get(), samples_, GL_DEPTH_COMPONENT32F, width, height);
  many_framebuffer_ = GlFramebuffer::Make();
  glNamedFramebufferRenderbuffer(many_framebuffer_.get(), GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, many_colour_.get());
  glNamedFramebufferRenderbuffer(many_framebuffer_.get(), GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, many_depth_.get());
  BELVEDERE_CHECK(glCheckNamedFramebufferStatus(many_framebuffer_.get(), GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE);
}

void FrameTarget::Begin(const std::optional<glm::vec3>& background) {
  const GLuint target = samples_ == 0 ? framebuffer_.get() : many_framebuffer_.get();
  glBindFramebuffer(GL_FRAMEBUFFER, target);
  glViewport(0, 0, width_, height_);
  const float far_depth = 0.0F;
  glDepthMask(GL_TRUE);
  if (background) {
    const std::array<float, 4> colour = {background->r, background->g, background->b, 1.0F};
    glClearNamedFramebufferfv(target, GL_COLOR, 0, colour.data());
  }
  glClearNamedFramebufferfv(target, GL_DEPTH, 0, &far_depth);
}

void FrameTarget::Resolve() {
  if (samples_ == 0) return;
  glBlitNamedFramebuffer(many_framebuffer_.get(), framebuffer_.get(), 0, 0, width_, height_, 0, 0, width_, height_,
                         GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

int FrameTarget::SamplesWorthTheirTime(const Clock& clock) {
  constexpr int kSamples = 4;
  constexpr int kTries = 16;  // the first while its clocks are still low
  constexpr double kMost_ms = 0.5;
  FrameTarget target(kSamples);
  target.Resize(1920, 1080);
  double least_ms = 1e9;
  for (int i = 0; i < kTries; ++i) {
    glFinish();
    const double start_s = clock.NowSeconds();
    target.Begin(glm::vec3(0));
    target.Resolve();
    glFinish();
    least_ms = std::min(least_ms, 1000 * (clock.NowSeconds() - start_s));
  }
  return least_ms <= kMost_ms ? kSamples : 0;
}

std::vector<uint8_t> FrameTarget::ReadRgb() const {
  std::vector<uint8_t> rgb(3 * static_cast<size_t>(width_) * static_cast<size_t>(height_));
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_.get());
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width_, height_, GL_RGB, GL_UNSIGNED_BYTE, rgb.data());
  FlipRows(rgb, 3 * static_cast<size_t>(width_));
  return rgb;
}

std::vector<float> FrameTarget::ReadDepth() const {
  if (samples_ != 0) {
    glBlitNamedFramebuffer(many_framebuffer_.get(), framebuffer_.get(), 0, 0, width_, height_, 0, 0, width_, height_,
                           GL_DEPTH_BUFFER_BIT, GL_NEAREST);
  }
  std::vector<float> depth(static_cast<size_t>(width_) * static_cast<size_t>(height_));
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_.get());
  glReadPixels(0, 0, width_, height_, GL_DEPTH_COMPONENT, GL_FLOAT, depth.data());
  FlipRows(depth, static_cast<size_t>(width_));
  return depth;
}

}  // namespace belvedere
