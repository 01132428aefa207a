// PartialFile: a file that is written beside its place, PATH.partial/NAME, and moved into it when it is whole.
//
// It has a folder of its own since libraries that write it leave further files beside it; what a writer that was killed
// left there is removed by the next. The name is that of the file, since some libraries ask for its ending.
//
// Threads: one at a time.
#pragma once

#include "runtime/base/status.h"

#include <memory>
#include <string>

namespace belvedere {

class PartialFile {
 public:
  static Result<std::unique_ptr<PartialFile>> Create(const std::string& path);
  ~PartialFile();  // removes what was not committed
  PartialFile(const PartialFile&) = delete;
  PartialFile& operator=(const PartialFile&) = delete;

  // To write to; the file is not there yet.
  const std::string& path() const { return partial_; }
  // Syncs the file and moves it over what is in its place. REQUIRES: it is written and closed.
  Status Commit();

 private:
  explicit PartialFile(const std::string& path);

  const std::string path_, folder_, partial_;
};

}  // namespace belvedere
