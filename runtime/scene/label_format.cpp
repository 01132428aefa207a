#include "runtime/scene/label_format.h"

#include "runtime/earth/ellipsoid.h"
#include "runtime/earth/units.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace belvedere {
namespace {

constexpr double kMetresPerFoot = 0.3048;
constexpr double kMpsPerKnot = 1852.0 / 3600.0;

std::string MarkingOf(const LabelFacts& facts) {
  const ObjectRecord& record = facts.record;
  return record.marking.empty() ? record.id.ToString() : std::string(record.marking.view());
}

std::string WholeNumber(double value) {
  return std::to_string(std::lround(value));
}

std::string LevelOf(const LabelFacts& facts) {
  if (!facts.record.type.is_air_platform()) return {};
  return fmt::format("FL{:03d}", std::max(0L, std::lround(facts.height_m / (100 * kMetresPerFoot))));
}

std::string HeadingOf(const LabelFacts& facts) {
  const LevelAxes axes = LevelAxesAt(facts.latitude_deg, facts.longitude_deg);
  const double east = glm::dot(facts.velocity_ecef_mps, axes.east),
               north = glm::dot(facts.velocity_ecef_mps, axes.north);
  const long degrees = std::lround(std::atan2(east, north) * kDegreesPerRadian);
  return fmt::format("{:03d}", (degrees + 360) % 360);
}

std::string ForceOf(const LabelFacts& facts) {
  constexpr std::array<const char*, 4> kNames = {"UNKNOWN", "FRIEND", "HOSTILE", "NEUTRAL"};
  return kNames[facts.record.force < kNames.size() ? facts.record.force : 0];
}

std::string DamageOf(const LabelFacts& facts) {
  constexpr std::array<const char*, 4> kNames = {"", "slight", "moderate", "destroyed"};
  return kNames[facts.record.damage()];
}

int WidthOfMarking(const ObjectRecord& record) {
  constexpr int kId = 10;
  return record.marking.empty() ? kId : static_cast<int>(record.marking.view().size());
}

template <int kCharacters>
int Width(const ObjectRecord& /*record*/) {
  return kCharacters;
}

}  // namespace

struct LabelFormat::Field {
  std::string_view name;
  std::string (*write)(const LabelFacts&);
  int (*width)(const ObjectRecord&);  // characters, about
};

std::span<const LabelFormat::Field> LabelFormat::Fields() {
  static constexpr std::array<Field, 12> kFields = {{
      {"marking", MarkingOf, WidthOfMarking},
      {"id", [](const LabelFacts& facts) { return facts.record.id.ToString(); }, Width<10>},
      {"type", [](const LabelFacts& facts) { return facts.record.type.ToString(); }, Width<16>},
      {"model", [](const LabelFacts& facts) { return std::string(facts.model); }, Width<10>},
      {"level", LevelOf, [](const ObjectRecord& record) { return record.type.is_air_platform() ? 5 : 0; }},
      {"altitude", [](const LabelFacts& facts) { return WholeNumber(facts.height_m / kMetresPerFoot); }, Width<5>},
      {"altitude_m", [](const LabelFacts& facts) { return WholeNumber(facts.height_m); }, Width<5>},
      {"speed", [](const LabelFacts& facts) { return WholeNumber(glm::length(facts.velocity_ecef_mps) / kMpsPerKnot); },
       Width<3>},
      {"speed_mps", [](const LabelFacts& facts) { return WholeNumber(glm::length(facts.velocity_ecef_mps)); },
       Width<3>},
      {"heading", HeadingOf, Width<3>},
      {"force", ForceOf, Width<7>},
      {"damage", DamageOf, [](const ObjectRecord& record) { return record.damage() == 0 ? 0 : 9; }},
  }};
  return kFields;
}

LabelFormat::LabelFormat() : LabelFormat(*Parse("{marking} {level}")) {}

Result<LabelFormat> LabelFormat::Parse(std::string_view text) {
  std::vector<Piece> pieces(1);
  while (!text.empty()) {
    if (text.starts_with("\\n")) {
      pieces.back().text += '\n';
      text.remove_prefix(2);
    } else if (text.front() != '{') {
      pieces.back().text += text.front();
      text.remove_prefix(1);
    } else {
      const size_t end = text.find('}');
      const std::string_view name = text.substr(1, end == std::string_view::npos ? end : end - 1);
      const std::span<const Field> fields = Fields();
      const auto field =
          std::find_if(fields.begin(), fields.end(), [&](const Field& known) { return known.name == name; });
      if (end == std::string_view::npos || field == fields.end()) {
        std::string names;
        for (const Field& known : fields) names += fmt::format("{}{{{}}}", names.empty() ? "" : ", ", known.name);
        return Status::Error("\"{}\" is no field of a label; there are {}", name, names);
      }
      pieces.back().field = &*field;
      pieces.emplace_back();
      text.remove_prefix(end + 1);
    }
  }
  return LabelFormat(std::move(pieces));
}

std::string LabelFormat::Write(const LabelFacts& facts) const {
  std::string whole;
  for (const Piece& piece : pieces_) {
    whole += piece.text;
    if (piece.field != nullptr) whole += piece.field->write(facts);
  }
  std::string lines;
  for (size_t begin = 0; begin < whole.size();) {
    const size_t end = std::min(whole.find('\n', begin), whole.size());
    const size_t first = whole.find_first_not_of(' ', begin);
    if (first < end) {
      if (!lines.empty()) lines += '\n';
      lines += whole.substr(first, whole.find_last_not_of(' ', end - 1) - first + 1);
    }
    begin = end + 1;
  }
  return lines;
}

LabelSize LabelFormat::SizeFor(const ObjectRecord& record) const {
  LabelSize size;
  int characters = 0;
  const auto end_line = [&] {
    size.characters = std::max(size.characters, characters);
    size.lines += characters > 0 ? 1 : 0;
    characters = 0;
  };
  for (const Piece& piece : pieces_) {
    for (const char character : piece.text) {
      if (character == '\n') {
        end_line();
      } else {
        characters += character == ' ' && characters == 0 ? 0 : 1;
      }
    }
    if (piece.field != nullptr) characters += piece.field->width(record);
  }
  end_line();
  return size;
}

}  // namespace belvedere
