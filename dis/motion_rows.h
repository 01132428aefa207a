// Rows of a CSV file of dead-reckoning cases: a state, and how far to take it.
//
// Columns, by name in the first line, in any order among others: id, drm, x0 y0 z0, psi0_rad theta0_rad phi0_rad,
// vx vy vz, ax ay az, wx wy wz, dt_s. Units and frames are those of KinematicState. Text may stand in double quotes.
#pragma once

#include "runtime/base/status.h"
#include "runtime/scene/motion.h"

#include <filesystem>
#include <string>
#include <vector>

namespace belvedere::dis {

struct MotionRow {
  std::string id;
  KinematicState state;
  double dt_s = 0;
};

// Says which line and column was wrong. `source` names the text in messages.
Result<std::vector<MotionRow>> ParseMotionRows(std::istream& text, const std::string& source);

}  // namespace belvedere::dis
