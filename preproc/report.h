// Report: what a build or a dataset is, for a person or as JSON.
//
// Threads: pure functions, but for VerifyDataset, which reads every page.
#pragma once

#include "preproc/build.h"
#include "runtime/paging/dataset.h"

#include <cstdint>
#include <string>
#include <vector>

namespace belvedere {

std::string BuildReportJson(const BuildReport& report);
std::string BuildReportLine(const BuildReport& report);

// "times 1.020, 0.980, 1.000 plus 3.1, -2.0, 0.0", of red, green and blue.
std::string FitText(const ColourFit& fit);

std::string DescribeDataset(const Dataset& dataset);
std::string DescribeDatasetJson(const Dataset& dataset);

struct Verification {
  int64_t pages = 0;
  uint32_t digest = 0;  // CRC-32C of layers, quadcodes and stored bytes: the same where the pages are, however stored
  std::vector<std::string> problems;  // one line each
};
// Reads and checks every page; that siblings exist together, and that level 0 is whole; and that posts which neighbours
// share are the same.
Verification VerifyDataset(const Dataset& dataset);

}  // namespace belvedere
