#include "render/window_system.h"

#include "render/gl_objects.h"
#include "runtime/base/log.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <atomic>
#include <utility>

namespace belvedere {
namespace {

std::string LastGlfwError() {
  const char* text = nullptr;
  glfwGetError(&text);
  return text == nullptr ? "unknown reason" : text;
}

void SetHints() {
  glfwDefaultWindowHints();
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_DEPTH_BITS, 0);
  glfwWindowHint(GLFW_STENCIL_BITS, 0);
}

// Which OpenGL the display has instead of 4.5; empty when none can be asked.
std::string OlderVersion() {
  glfwDefaultWindowHints();
  glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
  GLFWwindow* window = glfwCreateWindow(1, 1, "", nullptr, nullptr);
  if (window == nullptr) return {};
  glfwMakeContextCurrent(window);
  const auto* version = glGetString(GL_VERSION);
  std::string found = version == nullptr ? "" : reinterpret_cast<const char*>(version);
  glfwMakeContextCurrent(nullptr);
  glfwDestroyWindow(window);
  return found;
}

class GlfwContext final : public Context {
 public:
  explicit GlfwContext(GLFWwindow* window) : window_(window) {}
  Status MakeCurrent() override {
    if (glfwGetCurrentContext() != window_) glfwMakeContextCurrent(window_);
    if (glfwGetCurrentContext() == window_) return {};
    return Status::Error("display: cannot make the context current: {}; update the graphics driver", LastGlfwError());
  }
  void Release() override { glfwMakeContextCurrent(nullptr); }

 private:
  GLFWwindow* const window_;
};

struct KeyPair {
  int glfw;
  Key key;
};
constexpr KeyPair kKeys[] = {
    {GLFW_KEY_ESCAPE, Key::kEscape},
    {GLFW_KEY_ENTER, Key::kEnter},
    {GLFW_KEY_KP_ENTER, Key::kEnter},
    {GLFW_KEY_TAB, Key::kTab},
    {GLFW_KEY_BACKSPACE, Key::kBackspace},
    {GLFW_KEY_INSERT, Key::kInsert},
    {GLFW_KEY_DELETE, Key::kDelete},
    {GLFW_KEY_RIGHT, Key::kRight},
    {GLFW_KEY_LEFT, Key::kLeft},
    {GLFW_KEY_DOWN, Key::kDown},
    {GLFW_KEY_UP, Key::kUp},
    {GLFW_KEY_PAGE_UP, Key::kPageUp},
    {GLFW_KEY_PAGE_DOWN, Key::kPageDown},
    {GLFW_KEY_HOME, Key::kHome},
    {GLFW_KEY_END, Key::kEnd},
    {GLFW_KEY_KP_ADD, Key::kKeypadAdd},
    {GLFW_KEY_KP_SUBTRACT, Key::kKeypadSubtract},
    {GLFW_KEY_LEFT_SHIFT, Key::kLeftShift},
    {GLFW_KEY_LEFT_CONTROL, Key::kLeftControl},
    {GLFW_KEY_LEFT_ALT, Key::kLeftAlt},
    {GLFW_KEY_RIGHT_SHIFT, Key::kRightShift},
    {GLFW_KEY_RIGHT_CONTROL, Key::kRightControl},
    {GLFW_KEY_RIGHT_ALT, Key::kRightAlt},
};

Key FromGlfw(int key) {
  if (key > 0 && key < 128) return KeyOf(static_cast<char>(key));
  if (key >= GLFW_KEY_F1 && key <= GLFW_KEY_F12) {
    return static_cast<Key>(static_cast<int>(Key::kF1) + key - GLFW_KEY_F1);
  }
  const auto* found =
      std::find_if(std::begin(kKeys), std::end(kKeys), [&](const KeyPair& pair) { return pair.glfw == key; });
  return found == std::end(kKeys) ? Key::kUnknown : found->key;
}

Modifiers FromGlfwModifiers(int modifiers) {
  return {(modifiers & GLFW_MOD_SHIFT) != 0, (modifiers & GLFW_MOD_CONTROL) != 0, (modifiers & GLFW_MOD_ALT) != 0};
}

// One window, and the showing of pictures in it.
class Window final : public Presenter {
 public:
  Window(WindowId id, GLFWwindow* window, std::vector<InputEvent>& events, const Clock& clock)
      : id_(id), window_(window), events_(events), clock_(clock) {
    glfwSetWindowUserPointer(window_, this);
    UpdateScale();
    glfwSetKeyCallback(window_, [](GLFWwindow* w, int key, int, int action, int modifiers) {
      InputEvent& event = Of(w).Push(InputEvent::Kind::kKey);
      event.key = FromGlfw(key);
      event.pressed = action != GLFW_RELEASE;
      event.repeated = action == GLFW_REPEAT;
      event.modifiers = FromGlfwModifiers(modifiers);
    });
    glfwSetMouseButtonCallback(window_, [](GLFWwindow* w, int button, int action, int modifiers) {
      if (button > GLFW_MOUSE_BUTTON_MIDDLE) return;
      InputEvent& event = Of(w).PushAtCursor(InputEvent::Kind::kMouseButton);
      event.button = static_cast<MouseButton>(button);
      event.pressed = action == GLFW_PRESS;
      event.modifiers = FromGlfwModifiers(modifiers);
    });
    glfwSetCursorPosCallback(window_,
                             [](GLFWwindow* w, double, double) { Of(w).PushAtCursor(InputEvent::Kind::kMouseMove); });
    glfwSetScrollCallback(window_, [](GLFWwindow* w, double x, double y) {
      InputEvent& event = Of(w).PushAtCursor(InputEvent::Kind::kScroll);
      event.scroll_x = x;
      event.scroll_y = y;
    });
    glfwSetFramebufferSizeCallback(window_, [](GLFWwindow* w, int width, int height) {
      Of(w).UpdateScale();
      InputEvent& event = Of(w).Push(InputEvent::Kind::kResize);
      event.width_px = width;
      event.height_px = height;
    });
    glfwSetWindowCloseCallback(window_, [](GLFWwindow* w) {
      glfwSetWindowShouldClose(w, GLFW_FALSE);  // the UI thread decides
      Of(w).Push(InputEvent::Kind::kClose);
    });
  }
  ~Window() override { glfwDestroyWindow(window_); }
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  void Present(GLuint colour_texture, int width, int height) override {
    GLsync drawn = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    glFlush();
    glfwMakeContextCurrent(window_);
    if (glfwGetCurrentContext() != window_) return;
    glWaitSync(drawn, 0, GL_TIMEOUT_IGNORED);
    if (!framebuffer_made_) {
      glfwSwapInterval(0);  // the render thread paces itself, once for all windows
      // Deleted with the window's context.
      glCreateFramebuffers(1, &framebuffer_);
      framebuffer_made_ = true;
    }
    glNamedFramebufferTexture(framebuffer_, GL_COLOR_ATTACHMENT0, colour_texture, 0);
    const int shown_width = width_px_.load();
    const int shown_height = height_px_.load();
    const bool same_size = shown_width == width && shown_height == height;
    glBlitNamedFramebuffer(framebuffer_, 0, 0, 0, width, height, 0, 0, shown_width, shown_height, GL_COLOR_BUFFER_BIT,
                           same_size ? GL_NEAREST : GL_LINEAR);
    glfwSwapBuffers(window_);
    // A texture that is attached here would outlive its deletion by the view.
    glNamedFramebufferTexture(framebuffer_, GL_COLOR_ATTACHMENT0, 0, 0);
    glDeleteSync(drawn);
  }

  WindowId id() const { return id_; }
  GLFWwindow* glfw() const { return window_; }
  WindowSystem::Size size() const { return {width_px_.load(), height_px_.load()}; }

 private:
  static Window& Of(GLFWwindow* window) { return *static_cast<Window*>(glfwGetWindowUserPointer(window)); }

  InputEvent& Push(InputEvent::Kind kind) {
    InputEvent& event = events_.emplace_back();
    event.kind = kind;
    event.window = id_;
    event.time_s = clock_.NowSeconds();
    return event;
  }
  InputEvent& PushAtCursor(InputEvent::Kind kind) {
    InputEvent& event = Push(kind);
    glfwGetCursorPos(window_, &event.x, &event.y);
    event.x *= pixels_per_unit_;
    event.y *= pixels_per_unit_;
    return event;
  }
  // Cursor positions come in the window's units, of which a dense screen has fewer than pixels.
  void UpdateScale() {
    int width = 0;
    int height = 0;
    int units = 0;
    int unused = 0;
    glfwGetFramebufferSize(window_, &width, &height);
    glfwGetWindowSize(window_, &units, &unused);
    width_px_ = width;
    height_px_ = height;
    pixels_per_unit_ = units > 0 ? static_cast<double>(width) / units : 1.0;
  }

  const WindowId id_;
  GLFWwindow* const window_;
  std::vector<InputEvent>& events_;
  const Clock& clock_;
  std::atomic<int> width_px_{0}, height_px_{0};
  double pixels_per_unit_ = 1;
  bool framebuffer_made_ = false;  // render thread
  GLuint framebuffer_ = 0;         // render thread, in the window's context
};

}  // namespace

struct WindowSystem::State {
  explicit State(const Clock& injected) : clock(injected) {}
  ~State() {
    windows.clear();
    if (shared != nullptr) glfwDestroyWindow(shared);
    glfwTerminate();
  }
  const Clock& clock;
  GLFWwindow* shared = nullptr;
  std::vector<std::unique_ptr<Window>> windows;
  std::vector<InputEvent> events;
  WindowId last_id = 0;

  Window& At(WindowId id) {
    const auto found = std::find_if(windows.begin(), windows.end(), [&](const auto& w) { return w->id() == id; });
    BELVEDERE_CHECK(found != windows.end());
    return **found;
  }
};

Result<std::unique_ptr<WindowSystem>> WindowSystem::Make(const Clock& clock) {
  if (glfwInit() != GLFW_TRUE) {
    return Status::Error("display: none can be opened: {}; set DISPLAY, or run with --headless", LastGlfwError());
  }
  auto state = std::make_unique<State>(clock);
  SetHints();
  glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
  state->shared = glfwCreateWindow(1, 1, "Belvedere", nullptr, nullptr);
  if (state->shared == nullptr) return TooOldForUs("display", OlderVersion());
  return std::unique_ptr<WindowSystem>(new WindowSystem(std::move(state)));
}

WindowSystem::WindowSystem(std::unique_ptr<State> state) : state_(std::move(state)) {}
WindowSystem::~WindowSystem() = default;

std::unique_ptr<Context> WindowSystem::SharedContext() {
  return std::make_unique<GlfwContext>(state_->shared);
}

Result<WindowId> WindowSystem::CreateWindow(const WindowOptions& options) {
  SetHints();
  glfwWindowHint(GLFW_VISIBLE, options.x_px && options.y_px ? GLFW_FALSE : GLFW_TRUE);
  GLFWmonitor* monitor = options.fullscreen ? glfwGetPrimaryMonitor() : nullptr;
  int width = options.width_px;
  int height = options.height_px;
  if (monitor != nullptr) {
    const GLFWvidmode* mode = glfwGetVideoMode(monitor);
    width = mode->width;
    height = mode->height;
  }
  GLFWwindow* window = glfwCreateWindow(width, height, options.title.c_str(), monitor, state_->shared);
  if (window == nullptr) return Status::Error("window '{}': cannot be opened: {}", options.title, LastGlfwError());
  if (monitor == nullptr && options.x_px && options.y_px) {
    glfwSetWindowPos(window, *options.x_px, *options.y_px);
    glfwShowWindow(window);
  }
  const WindowId id = ++state_->last_id;
  state_->windows.push_back(std::make_unique<Window>(id, window, state_->events, state_->clock));
  return id;
}

void WindowSystem::CloseWindow(WindowId window) {
  std::erase_if(state_->windows, [&](const auto& open) { return open->id() == window; });
}

void WindowSystem::SetTitle(WindowId window, const std::string& title) {
  glfwSetWindowTitle(state_->At(window).glfw(), title.c_str());
}

Presenter* WindowSystem::PresenterOf(WindowId window) {
  return &state_->At(window);
}
WindowSystem::Size WindowSystem::SizeOf(WindowId window) const {
  return state_->At(window).size();
}

void WindowSystem::PollEvents(std::vector<InputEvent>& events, double longest_wait_s) {
  if (longest_wait_s > 0) {
    glfwWaitEventsTimeout(longest_wait_s);
  } else {
    glfwPollEvents();
  }
  events.insert(events.end(), state_->events.begin(), state_->events.end());
  state_->events.clear();
}

void WindowSystem::Wake() {
  glfwPostEmptyEvent();
}

}  // namespace belvedere
