// The importance table as its TOML file has it: [[rule]] tables of a value and of terms, each a trapezoid of four
// numbers over one of the inputs (importance.h):
//
//   [[rule]]
//   value = 0.9
//   opposing = [0.0, 0.5, 1, 1]
//   distance = [0, 0, 20e3, 60e3]
//
// Threads: pure functions.
#pragma once

#include "runtime/base/status.h"
#include "runtime/scene/importance.h"

#include <string>
#include <string_view>

namespace belvedere {

Result<ImportanceTable> LoadImportance(const std::string& path);
// name: stands in messages.
Result<ImportanceTable> ParseImportance(std::string_view text, const std::string& name);

}  // namespace belvedere
