#include "runtime/paging/folder_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

namespace belvedere {
namespace {

// Whoever held the lock before may have removed the folder, and a third made it anew: then this is not the one to hold.
bool IsStillAt(int descriptor, const std::string& path) {
  struct stat held {
  }, there{};
  return fstat(descriptor, &held) == 0 && stat(path.c_str(), &there) == 0 && held.st_ino == there.st_ino &&
         held.st_dev == there.st_dev;
}

}  // namespace

Result<std::unique_ptr<FolderLock>> FolderLock::Take(const std::string& folder) {
  for (;;) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) return Status::Error("{}: cannot make the folder: {}", folder, error.message());
    const int descriptor = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0) {
      if (errno == ENOENT) continue;
      return Status::Error("{}: cannot open the folder: {}", folder, std::strerror(errno));
    }
    if (flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
      const int reason = errno;
      close(descriptor);
      if (reason == EWOULDBLOCK) return Status::Error("{}: another build is at work there; wait for it", folder);
      return Status::Error("{}: cannot be locked: {}", folder, std::strerror(reason));
    }
    if (IsStillAt(descriptor, folder)) return std::unique_ptr<FolderLock>(new FolderLock(descriptor));
    close(descriptor);
  }
}

FolderLock::~FolderLock() {
  close(descriptor_);
}

}  // namespace belvedere
