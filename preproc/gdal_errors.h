// GdalErrors: the first error that GDAL reports on this thread while it lives.
//
// Closing a file returns nothing in GDAL, so that a full disk shows here alone.
//
// Threads: the one that made it.
#pragma once

#include <cpl_error.h>

#include <algorithm>
#include <string>

namespace belvedere {

// Of this thread since CPLErrorReset. One line.
inline std::string LastGdalError() {
  std::string text = CPLGetLastErrorMsg();
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text.empty() ? "GDAL gives no reason" : text;
}

class GdalErrors {
 public:
  GdalErrors() { CPLPushErrorHandlerEx(Take, this); }
  ~GdalErrors() { CPLPopErrorHandler(); }
  GdalErrors(const GdalErrors&) = delete;
  GdalErrors& operator=(const GdalErrors&) = delete;

  bool any() const { return !first_.empty(); }
  // One line.
  std::string first() const { return any() ? first_ : "GDAL gives no reason"; }

 private:
  static void CPL_STDCALL Take(CPLErr kind, CPLErrorNum /*number*/, const char* text) {
    auto& errors = *static_cast<GdalErrors*>(CPLGetErrorHandlerUserData());
    if (kind < CE_Failure || errors.any()) return;
    errors.first_ = text;
    std::replace(errors.first_.begin(), errors.first_.end(), '\n', ' ');
  }

  std::string first_;
};

}  // namespace belvedere
