// Source settings: a source as its spec has it, as JSON that the dataset keeps, so that it can be changed later without
// the spec; and the state of a source's files, by which it is seen that they have changed.
//
// Threads: pure functions; StateOfFiles asks the file system.
#pragma once

#include "preproc/spec.h"
#include "runtime/base/status.h"

#include <string>
#include <string_view>
#include <vector>

namespace belvedere {

// One line. Paths to open are made absolute, so that it does not matter where the program is run.
std::string SettingsToJson(const SourceSpec& source);
// The reason alone where the text is none of SettingsToJson.
Result<SourceSpec> SettingsFromJson(std::string_view text);

// Names without their folders, sizes and times of last change, or of many files a checksum of that: the same where no
// file was written to.
std::string StateOfFiles(const std::vector<std::string>& paths);

}  // namespace belvedere
