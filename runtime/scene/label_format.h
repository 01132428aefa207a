// LabelFormat: what stands in an object's data block, as the user writes it: text with fields in braces, \\n for a new
// line: "{marking} {level}\\n{speed} kt {heading}".
//
//   marking     what the sender calls it; its id where it has no marking
//   id          site:application:entity
//   type        the seven numbers of its entity type
//   model       the catalogue's name of what it looks like: airliner, tank, ...
//   level       FL350 of aircraft, else nothing
//   altitude    feet above the ellipsoid      altitude_m  the same in metres
//   speed       knots over the ground         speed_mps   metres a second
//   heading     of its motion, 000 to 359     force       FRIEND, HOSTILE, NEUTRAL or UNKNOWN
//   damage      slight, moderate, destroyed, or nothing
//
// Lines without anything in them are left out, and so are spaces at their ends.
// Threads: immutable once made.
#pragma once

#include "runtime/base/status.h"
#include "runtime/scene/label_box.h"
#include "runtime/scene/object_table.h"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace belvedere {

// What the fields are made of. latitude and longitude in degrees.
struct LabelFacts {
  const ObjectRecord& record;
  std::string_view model;
  double latitude_deg = 0, longitude_deg = 0, height_m = 0;
  glm::dvec3 velocity_ecef_mps{0.0};
};

class LabelFormat {
 public:
  LabelFormat();  // "{marking} {level}"
  // The error names the field that is not known.
  static Result<LabelFormat> Parse(std::string_view text);
  std::string Write(const LabelFacts& facts) const;
  // About the size of what Write gives, for much less.
  LabelSize SizeFor(const ObjectRecord& record) const;

 private:
  struct Field;
  struct Piece {
    std::string text;
    const Field* field = nullptr;  // after the text
  };
  static std::span<const Field> Fields();
  explicit LabelFormat(std::vector<Piece> pieces) : pieces_(std::move(pieces)) {}
  std::vector<Piece> pieces_;
};

}  // namespace belvedere
