#include "render/render_options.h"

namespace belvedere {

RenderOptions WithDefaults(RenderOptions options, bool software) {
  const auto set = [&](auto& option, auto on_software, auto on_gpu) {
    if (option < 0) option = software ? on_software : on_gpu;
  };
  set(options.upload_budget_ms, 4.0, 1.0);
  set(options.colour_slots, 384, 768);
  set(options.overlay_slots, 480, 2048);
  set(options.samples, 0, -1);
  return options;
}

}  // namespace belvedere
