// FolderLock: a folder that one process at a time works in. The system lets go of it when the process ends, however
// that comes about.
//
// Threads: one at a time. Owns: the lock, until destruction; the folder stays.
#pragma once

#include "runtime/base/status.h"

#include <memory>
#include <string>

namespace belvedere {

class FolderLock {
 public:
  // Makes the folder where it is not there. Fails at once where another holds it.
  static Result<std::unique_ptr<FolderLock>> Take(const std::string& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  explicit FolderLock(int descriptor) : descriptor_(descriptor) {}

  const int descriptor_;
};

}  // namespace belvedere
