// FrameTarget: the picture that a view is drawn into: RGBA8 colour and 32-bit float depth, with or without
// multisampling. Its colour texture can be shown by any context that shares with the one that made it.
//
// Depth is reverse-Z: cleared to 0, which is infinitely far. It is resolved where it is read, colour in every frame.
// Threads: the render thread.
#pragma once

#include "render/gl_objects.h"
#include "runtime/base/clock.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <optional>
#include <vector>

namespace belvedere {

class FrameTarget {
 public:
  // samples: 0 none.
  explicit FrameTarget(int samples) : samples_(samples) {}

  // Makes it that size; does nothing when it is. REQUIRES: 0 < width, height
  void Resize(int width, int height);
  // Draws go here from now on; clears it. background: nullopt where every pixel is drawn over.
  void Begin(const std::optional<glm::vec3>& background);
  // What was drawn is in the colour texture.
  void Resolve();
  GLuint colour_texture() const { return colour_.get(); }
  int width() const { return width_; }
  int height() const { return height_; }

  // After Resolve; rows from the top.
  std::vector<uint8_t> ReadRgb() const;
  std::vector<float> ReadDepth() const;

  // 4 samples, where the current context clears and resolves two million pixels of them fast enough for 240 frames/s
  // with four times as many pixels; else none: some GPUs are made for anything but this.
  static int SamplesWorthTheirTime(const Clock& clock);

 private:
  const int samples_;
  int width_ = 0, height_ = 0;
  GlTexture colour_;
  GlRenderbuffer depth_;
  GlFramebuffer framebuffer_;
  GlRenderbuffer many_colour_, many_depth_;  // with samples_ only
  GlFramebuffer many_framebuffer_;
};

}  // namespace belvedere
