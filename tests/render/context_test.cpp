#include "render/context.h"

#include "render/gl_objects.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>

namespace belvedere {
namespace {

// Each in a process of its own: drivers read the environment once.
void ExitWithOutcome() {
  auto context = MakeOffscreenContext();
  Status status = context.ok() ? (*context)->MakeCurrent() : context.status();
  if (status.ok()) status = InspectContext().status();
  std::fprintf(stderr, "%s\n", status.ok() ? "a context" : status.message().c_str());
  std::exit(status.ok() ? 0 : 1);
}

class ContextDeathTest : public ::testing::Test {
 protected:
  ContextDeathTest() { GTEST_FLAG_SET(death_test_style, "threadsafe"); }
};

TEST_F(ContextDeathTest, AnOlderOpenGLIsNamed) {
  EXPECT_EXIT(
      {
        setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
        setenv("MESA_GL_VERSION_OVERRIDE", "3.3", 1);
        ExitWithOutcome();
      },
      ::testing::ExitedWithCode(1), "OpenGL 4.5 core is needed, found 3\\.3");
}

TEST_F(ContextDeathTest, NoDriverAtAll) {
  EXPECT_EXIT(
      {
        setenv("__EGL_VENDOR_LIBRARY_FILENAMES", "/nonexistent.json", 1);
        ExitWithOutcome();
      },
      ::testing::ExitedWithCode(1), "off-screen EGL: no EGL display can be opened");
}

TEST(Context, IsMadeOffScreenAndSaysWhatItIs) {
  auto context = MakeOffscreenContext();
  ASSERT_TRUE(context.ok()) << context.message();
  ASSERT_TRUE((*context)->MakeCurrent().ok());
  const auto facts = InspectContext();
  ASSERT_TRUE(facts.ok()) << facts.message();
  EXPECT_FALSE(facts->renderer.empty());
  EXPECT_EQ(facts->software, facts->renderer.find("llvmpipe") != std::string::npos);
  (*context)->Release();
}

TEST(Context, TwoCanBeUsedInTurn) {
  auto a = MakeOffscreenContext();
  auto b = MakeOffscreenContext();
  ASSERT_TRUE(a.ok() && b.ok());
  ASSERT_TRUE((*a)->MakeCurrent().ok());
  const GlBuffer in_a = GlBuffer::Make();
  ASSERT_TRUE((*b)->MakeCurrent().ok());
  EXPECT_FALSE(glIsBuffer(in_a.get()));
  ASSERT_TRUE((*a)->MakeCurrent().ok());
  EXPECT_TRUE(glIsBuffer(in_a.get()));
}

}  // namespace
}  // namespace belvedere
