#include "preproc/partial_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

namespace belvedere {

namespace fs = std::filesystem;

PartialFile::PartialFile(const std::string& path)
    : path_(path), folder_(path + ".partial"), partial_((fs::path(folder_) / fs::path(path).filename()).string()) {}

Result<std::unique_ptr<PartialFile>> PartialFile::Create(const std::string& path) {
  std::error_code error;
  if (fs::is_directory(path, error)) return Status::Error("{}: is a folder; give the name of a file", path);
  std::unique_ptr<PartialFile> file(new PartialFile(path));
  fs::remove_all(file->folder_, error);
  if (!fs::create_directory(file->folder_, error)) {
    return Status::Error("{}: cannot be written beside its place: {}; check the folder", path,
                         error ? error.message() : "its folder is there already");
  }
  return file;
}

PartialFile::~PartialFile() {
  std::error_code error;
  fs::remove_all(folder_, error);
}

Status PartialFile::Commit() {
  const int descriptor = open(partial_.c_str(), O_RDONLY | O_CLOEXEC);
  const bool synced = descriptor >= 0 && fsync(descriptor) == 0;
  const int reason = errno;
  if (descriptor >= 0) close(descriptor);
  if (!synced) return Status::Error("{}: cannot be written: {}", path_, std::strerror(reason));
  std::error_code error;
  fs::rename(partial_, path_, error);
  if (error) return Status::Error("{}: cannot be moved into place: {}", path_, error.message());
  return {};
}

}  // namespace belvedere
