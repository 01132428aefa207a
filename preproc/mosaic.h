// Mosaic: the files that a spec names together, by a folder or a pattern, as the sources that they make.
//
// Files whose pixels lie on one grid are one source, so that nothing shows where they meet and a feather follows the
// border of all: the same CRS, pixel size, bands, types and nodata, and a whole number of pixels apart. Other files are
// sources of their own. Sources are in the order of their first file's name, and where files of one overlap the last by
// name wins. They are found anew whenever the spec is used, so that a file that has come since is seen.
//
// A pattern has `*`, `?` or `[..]`, as a shell's; `**` is any number of folders. A folder stands for all files below it
// that are rasters. What the pattern names and GDAL cannot read is said, and the rest is built.
//
// Threads: the file system is asked, and GDAL, whose drivers must be there (PrepareGdal); else pure functions.
#pragma once

#include "preproc/spec.h"
#include "runtime/base/status.h"

#include <string>
#include <string_view>
#include <vector>

namespace belvedere {

struct UnusableFile {
  std::string path;
  std::string reason;
};

// Whether the path, as resolved, stands for files rather than for one dataset of GDAL's.
bool IsPattern(const std::string& path);

// What the pattern or folder names, in the order of the names.
Result<std::vector<std::string>> FilesOf(const std::string& written);

struct Mosaics {
  std::vector<SourceSpec> sources;  // with `files`, and with `tiles` where there is more than one
  std::vector<UnusableFile> unusable;
};
// Of a source with such a path. Fails, with the reason alone, where nothing of it can be used.
Result<Mosaics> MosaicsOf(const SourceSpec& source);

// Puts in the place of each source with such a path those that its files make; several in a row that differ in `tiles`
// alone, as an earlier expansion left them, count as one. A source of which nothing can be used stays as it is, and
// fails as it is opened. Gives what cannot be used of the others.
std::vector<UnusableFile> ExpandMosaics(BuildSpec& spec);

// What GDAL is to open for it: its path, its one file, or a virtual raster of its files or of the part that it names.
Result<std::string> PathToOpen(const SourceSpec& source);

}  // namespace belvedere
