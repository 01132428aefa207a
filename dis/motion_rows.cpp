#include "dis/motion_rows.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <istream>
#include <string_view>

namespace belvedere::dis {
namespace {

std::vector<std::string> SplitCells(std::string_view line) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (const char character : line) {
    if (character == '"') {
      quoted = !quoted;
    } else if (character == ',' && !quoted) {
      cells.emplace_back();
    } else if (character != '\r') {
      cells.back() += character;
    }
  }
  return cells;
}

// The columns that hold numbers, in the order in which ToRow takes them.
constexpr std::array<std::string_view, 17> kNumbers = {"drm",      "x0", "y0", "z0", "psi0_rad", "theta0_rad",
                                                       "phi0_rad", "vx", "vy", "vz", "ax",       "ay",
                                                       "az",       "wx", "wy", "wz", "dt_s"};

MotionRow ToRow(const std::string& id, const std::array<double, kNumbers.size()>& v) {
  MotionRow row;
  row.id = id;
  const bool whole = v[0] >= 1 && v[0] <= 9 && v[0] == std::floor(v[0]);
  row.state.model = DeadReckoningModel(whole ? static_cast<int>(v[0]) : 0);
  row.state.position_ecef = {v[1], v[2], v[3]};
  row.state.orientation = {v[4], v[5], v[6]};
  row.state.velocity_mps = {v[7], v[8], v[9]};
  row.state.acceleration_mps2 = {v[10], v[11], v[12]};
  row.state.angular_velocity_radps = {v[13], v[14], v[15]};
  row.dt_s = v[16];
  return row;
}

}  // namespace

Result<std::vector<MotionRow>> ParseMotionRows(std::istream& text, const std::string& source) {
  std::string line;
  std::getline(text, line);
  const std::vector<std::string> names = SplitCells(line);
  const auto column = [&](std::string_view name) {
    return static_cast<size_t>(std::ranges::find(names, name) - names.begin());
  };
  const size_t id_column = column("id");
  std::array<size_t, kNumbers.size()> columns{};
  for (size_t i = 0; i < kNumbers.size(); ++i) {
    columns[i] = column(kNumbers[i]);
    if (columns[i] == names.size()) return Status::Error("{}: the first line has no column '{}'", source, kNumbers[i]);
  }
  std::vector<MotionRow> rows;
  for (size_t number = 2; std::getline(text, line); ++number) {
    const std::vector<std::string> cells = SplitCells(line);
    if (cells.size() == 1 && cells[0].empty()) continue;
    std::array<double, kNumbers.size()> values{};
    for (size_t i = 0; i < kNumbers.size(); ++i) {
      const std::string cell = columns[i] < cells.size() ? cells[columns[i]] : std::string();
      const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), values[i]);
      if (error != std::errc() || end != cell.data() + cell.size() || !std::isfinite(values[i])) {
        return Status::Error("{}:{}: column '{}': '{}' is not a number", source, number, kNumbers[i], cell);
      }
    }
    rows.push_back(ToRow(id_column < cells.size() ? cells[id_column] : std::to_string(number - 1), values));
  }
  return rows;
}

}  // namespace belvedere::dis
