// The written form of commands, as station files and key tables have them.
//
//   zoom STEPS                 look RIGHT UP (fractions of the picture)     orbit AROUND_DEG TILT_DEG
//   fly FORWARD RIGHT UP [TURN PITCH]      goto LAT LON HEIGHT_M [HEADING PITCH]      home
//   error PX        error *FACTOR          toggle
//   hud|labels|objects|symbols|sky|wireframe|volumes|pages|frozen|effects|trails|vectors|groups|frames tint
//   none|error|level|frame|image|next layer NAME|NUMBER toggle|on|off|opacity=X|gamma=X|multiplier=X|role=ROLE target
//   next|previous                   time +SECONDS|-SECONDS           picture       quit
//
// zoom and orbit act on the middle of the picture. What a mouse does (grab, pan) has no written form.
// Threads: pure functions.
#pragma once

#include "runtime/base/status.h"
#include "runtime/scene/commands.h"

#include <string_view>

namespace belvedere {

// width_px, height_px: of the picture whose middle zoom and orbit mean.
Result<Command> ParseCommand(std::string_view text, int width_px, int height_px);

}  // namespace belvedere
