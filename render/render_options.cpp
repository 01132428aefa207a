#include "render/render_options.h"

namespace belvedere {

RenderOptions WithDefaults(RenderOptions options, bool software) {
  const auto set = [&](int& option, int on_software, int on_gpu) {
    if (option < 0) option = software ? on_software : on_gpu;
  };
  set(options.colour_slots, 384, 768);
  set(options.overlay_slots, 480, 2048);
  set(options.samples, 0, 4);
  return options;
}

}  // namespace belvedere
