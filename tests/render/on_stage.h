// OnStage: a test with a made scene, a clock that it moves, and a renderer of its own off-screen.
#pragma once

#include "tests/render/synthetic_scene.h"

#include <gtest/gtest.h>

#include <memory>
#include <utility>

namespace belvedere::testing {

class OnStage : public ::testing::Test {
 protected:
  // slots: images of each kind that the GPU has room for.
  void Open(int slots, int samples = 0) {
    RenderOptions options;
    options.colour_slots = options.overlay_slots = slots;
    options.samples = samples;
    stage_.reset();  // one context at a time
    auto stage = Stage::Make(scene_, options, clock_);
    ASSERT_TRUE(stage.ok()) << stage.message();
    stage_ = std::move(*stage);
  }

  ManualClock clock_;
  Scene scene_;
  std::unique_ptr<Stage> stage_;
};

}  // namespace belvedere::testing
