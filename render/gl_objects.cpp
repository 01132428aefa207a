#include "render/gl_objects.h"

#include "runtime/base/log.h"
#include "runtime/base/status.h"

#include <array>
#include <vector>

namespace belvedere {
namespace {

constexpr GLuint64 kLongestWait_ns = 1'000'000'000;

GLuint Compile(std::string_view name, GLenum stage, const std::string& source, const std::string& defines) {
  const std::string text = "#version 450 core\n" + defines + source;
  const GLuint shader = glCreateShader(stage);
  const char* pointer = text.c_str();
  glShaderSource(shader, 1, &pointer, nullptr);
  glCompileShader(shader);
  GLint compiled = GL_FALSE;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
  if (compiled != GL_TRUE) {
    std::array<char, 4096> log{};
    glGetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), nullptr, log.data());
    LogError("shader {}: does not compile: {}", name, log.data());
  }
  BELVEDERE_CHECK(compiled == GL_TRUE);
  return shader;
}

}  // namespace

void FramesInFlight::EndFrame() {
  GLsync ended = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
  glFlush();
  Drain();
  previous_ = ended;
}

void FramesInFlight::Drain() {
  if (previous_ != nullptr) glClientWaitSync(previous_, GL_SYNC_FLUSH_COMMANDS_BIT, kLongestWait_ns);
  Forget();
}

void FramesInFlight::Forget() {
  glDeleteSync(previous_);
  previous_ = nullptr;
}

GlProgram MakeProgram(std::string_view name, const std::string& vertex_source, const std::string& fragment_source,
                      const std::string& defines) {
  GlProgram program = GlProgram::Make();
  const GLuint vertex = Compile(name, GL_VERTEX_SHADER, vertex_source, defines);
  const GLuint fragment = Compile(name, GL_FRAGMENT_SHADER, fragment_source, defines);
  glAttachShader(program.get(), vertex);
  glAttachShader(program.get(), fragment);
  glLinkProgram(program.get());
  glDeleteShader(vertex);
  glDeleteShader(fragment);
  GLint linked = GL_FALSE;
  glGetProgramiv(program.get(), GL_LINK_STATUS, &linked);
  if (linked != GL_TRUE) {
    std::array<char, 4096> log{};
    glGetProgramInfoLog(program.get(), static_cast<GLsizei>(log.size()), nullptr, log.data());
    LogError("shader {}: does not link: {}", name, log.data());
  }
  BELVEDERE_CHECK(linked == GL_TRUE);
  return program;
}

}  // namespace belvedere
