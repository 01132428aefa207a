// GL objects that delete themselves. Made by the direct-state-access functions of OpenGL 4.5.
//
// Threads: made, used and destroyed with the context current that made them (or one that shares with it, for buffers,
//          textures and renderbuffers).
#pragma once

#include <epoxy/gl.h>

#include <string>
#include <string_view>
#include <utility>

namespace belvedere {

// Traits: static void Create(GLuint*), static void Delete(GLuint).
template <typename Traits>
class GlName {
 public:
  GlName() = default;
  GlName(GlName&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
  GlName& operator=(GlName&& other) noexcept {
    std::swap(name_, other.name_);
    return *this;
  }
  GlName(const GlName&) = delete;
  GlName& operator=(const GlName&) = delete;
  ~GlName() {
    if (name_ != 0) Traits::Delete(name_);
  }
  static GlName Make() {
    GlName made;
    Traits::Create(&made.name_);
    return made;
  }
  GLuint get() const { return name_; }
  explicit operator bool() const { return name_ != 0; }

 private:
  GLuint name_ = 0;
};

struct BufferTraits {
  static void Create(GLuint* name) { glCreateBuffers(1, name); }
  static void Delete(GLuint name) { glDeleteBuffers(1, &name); }
};
struct TextureArrayTraits {
  static void Create(GLuint* name) { glCreateTextures(GL_TEXTURE_2D_ARRAY, 1, name); }
  static void Delete(GLuint name) { glDeleteTextures(1, &name); }
};
struct TextureTraits {
  static void Create(GLuint* name) { glCreateTextures(GL_TEXTURE_2D, 1, name); }
  static void Delete(GLuint name) { glDeleteTextures(1, &name); }
};
struct VertexArrayTraits {
  static void Create(GLuint* name) { glCreateVertexArrays(1, name); }
  static void Delete(GLuint name) { glDeleteVertexArrays(1, &name); }
};
struct FramebufferTraits {
  static void Create(GLuint* name) { glCreateFramebuffers(1, name); }
  static void Delete(GLuint name) { glDeleteFramebuffers(1, &name); }
};
struct RenderbufferTraits {
  static void Create(GLuint* name) { glCreateRenderbuffers(1, name); }
  static void Delete(GLuint name) { glDeleteRenderbuffers(1, &name); }
};
struct ProgramTraits {
  static void Create(GLuint* name) { *name = glCreateProgram(); }
  static void Delete(GLuint name) { glDeleteProgram(name); }
};

using GlBuffer = GlName<BufferTraits>;
using GlTextureArray = GlName<TextureArrayTraits>;
using GlTexture = GlName<TextureTraits>;
using GlVertexArray = GlName<VertexArrayTraits>;
using GlFramebuffer = GlName<FramebufferTraits>;
using GlRenderbuffer = GlName<RenderbufferTraits>;
using GlProgram = GlName<ProgramTraits>;

// One frame may still be drawn while the next is prepared: a renderer in software then has work for all its threads.
class FramesInFlight {
 public:
  FramesInFlight() = default;
  FramesInFlight(const FramesInFlight&) = delete;
  FramesInFlight& operator=(const FramesInFlight&) = delete;
  ~FramesInFlight() { Forget(); }
  // All commands of a frame have been given. Returns when the frame before it is drawn.
  void EndFrame();
  // Returns when all frames are drawn: before something is written that they may still read.
  void Drain();

 private:
  void Forget();
  GLsync previous_ = nullptr;
};

// Compiles and links shaders of shaders/; `defines` ("#define A 1\n...") goes after the #version line of both.
// REQUIRES: the sources are ours, so that a failure is a broken contract; it prints the compiler's log and stops.
GlProgram MakeProgram(std::string_view name, const std::string& vertex_source, const std::string& fragment_source,
                      const std::string& defines = {});

}  // namespace belvedere
