// ReportPage: what a build made, as one HTML page to look at.
//
// Layers with pictures, a map of how fine they are and where their sources lie, heights, pages and bytes by level;
// sources with their coordinate system and datum; what was left out and what was odd; times. The page is whole in
// itself (pictures are data URIs, there is no script, and its policy lets nothing be fetched) and made of the dataset's
// coarse pages and of what the build noted: no source is read again. Whatever comes from a spec or a source is escaped.
//
// Where there is a great number of sources, steps or remarks the first are shown, and how many there are.
//
// Threads: pure functions that read pages.
#pragma once

#include "preproc/build.h"
#include "runtime/base/status.h"
#include "runtime/paging/dataset.h"

#include <string>

namespace belvedere {

Result<std::string> ReportPage(const Dataset& dataset, const BuildReport& report);
// Writes it to a file, beside its place first.
Status WriteReportPage(const Dataset& dataset, const BuildReport& report, const std::string& path);
// Where a dataset's own report lies, in its folder.
std::string ReportPathIn(const std::string& dataset_path);

}  // namespace belvedere
