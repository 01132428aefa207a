// The house as its plan says: reads the #include lines of every source file and holds the direction in which rooms, and
// the drawers of runtime, may depend on each other.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

const fs::path kRoot = BELVEDERE_SOURCE_DIR;
const std::set<std::string> kRooms{"servers", "managers", "render", "dis", "preproc"};
// Each drawer of runtime uses itself and those before it; app, the roof, uses everything.
const std::vector<std::string> kDrawers{"base", "earth", "paging", "scene"};

bool IsSource(const fs::path& path) {
  return path.extension() == ".h" || path.extension() == ".cpp";
}

std::vector<fs::path> SourcesUnder(const std::string& folder) {
  std::vector<fs::path> sources;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(kRoot / folder)) {
    if (entry.is_regular_file() && IsSource(entry.path())) sources.push_back(entry.path());
  }
  std::sort(sources.begin(), sources.end());
  return sources;
}

// What stands between the quotes of its #include "..." lines.
std::vector<std::string> IncludesOf(const fs::path& source) {
  std::vector<std::string> includes;
  std::ifstream file(source);
  for (std::string line; std::getline(file, line);) {
    if (line.rfind("#include \"", 0) != 0) continue;
    const size_t end = line.find('"', 10);
    includes.push_back(line.substr(10, end - 10));
  }
  return includes;
}

std::vector<std::string> PartsOf(const std::string& path) {
  std::vector<std::string> parts;
  for (const fs::path& part : fs::path(path)) parts.push_back(part.string());
  return parts;
}

int DrawerNumber(const std::string& drawer) {
  const auto found = std::find(kDrawers.begin(), kDrawers.end(), drawer);
  return found == kDrawers.end() ? -1 : static_cast<int>(found - kDrawers.begin());
}

TEST(Layout, IncludesAreWrittenFromTheRoot) {
  int includes = 0;
  for (const std::string room : {"runtime", "servers", "managers", "render", "dis", "preproc"}) {
    for (const fs::path& source : SourcesUnder(room)) {
      for (const std::string& include : IncludesOf(source)) {
        ++includes;
        EXPECT_NE(PartsOf(include).front(), "..") << source;
        EXPECT_TRUE(PartsOf(include).front() == "runtime" || kRooms.contains(PartsOf(include).front()))
            << source << " includes \"" << include << "\": write it from the root of the project";
      }
    }
  }
  EXPECT_GT(includes, 50);  // the reader of includes works
}

TEST(Layout, RoomsUseRuntimeAndThemselvesOnly) {
  for (const std::string& room : kRooms) {
    for (const fs::path& source : SourcesUnder(room)) {
      for (const std::string& include : IncludesOf(source)) {
        const std::vector<std::string> parts = PartsOf(include);
        const bool allowed = parts[0] == room || (parts[0] == "runtime" && parts[1] != "app");
        EXPECT_TRUE(allowed) << source << " includes " << include << ": a room uses the floor and itself";
      }
    }
  }
}

TEST(Layout, DrawersOfRuntimeUseThoseAboveThem) {
  for (const std::string& drawer : kDrawers) {
    for (const fs::path& source : SourcesUnder("runtime/" + drawer)) {
      for (const std::string& include : IncludesOf(source)) {
        const std::vector<std::string> parts = PartsOf(include);
        ASSERT_EQ(parts[0], "runtime") << source << " includes " << include;
        const int number = DrawerNumber(parts[1]);
        EXPECT_TRUE(number >= 0 && number <= DrawerNumber(drawer)) << source << " includes " << include;
      }
    }
  }
}

TEST(Layout, TheFloorHasNoWindowsAndNoSockets) {
  for (const std::string& drawer : kDrawers) {
    for (const fs::path& source : SourcesUnder("runtime/" + drawer)) {
      std::ifstream file(source);
      for (std::string line; std::getline(file, line);) {
        if (line.rfind("#include <", 0) != 0) continue;
        for (const char* unwanted : {"GL/", "EGL/", "GLFW/", "epoxy/", "boost/asio", "sys/socket.h", "netinet/"}) {
          EXPECT_EQ(line.find(unwanted), std::string::npos) << source << ": " << line;
        }
      }
    }
  }
}

TEST(Layout, TopLevelFoldersAreThoseOfThePlan) {
  const std::set<std::string> planned{"runtime", "servers", "managers", "render", "dis", "preproc", "tests", "docs"};
  for (const std::string& folder : planned) EXPECT_TRUE(fs::is_directory(kRoot / folder)) << folder;
  for (const fs::directory_entry& entry : fs::directory_iterator(kRoot)) {
    const std::string name = entry.path().filename().string();
    // Hidden folders, and what builds and demonstrations leave behind, are none of the house.
    const bool leftover = name.front() == '.' || name.rfind("build", 0) == 0 || name.rfind("demo-", 0) == 0;
    if (!entry.is_directory() || leftover) continue;
    EXPECT_TRUE(planned.contains(name)) << name;
  }
}

TEST(Layout, FilesStayShortAndAreNamedForWhatTheyHold) {
  for (const std::string folder : {"runtime", "servers", "managers", "render", "dis", "preproc"}) {
    for (const fs::path& source : SourcesUnder(folder)) {
      std::ifstream file(source);
      const auto lines = std::count(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>(), '\n');
      EXPECT_LE(lines, 500) << source << " should be two files";
      const std::string stem = source.stem().string();
      for (const char* vague : {"data", "info", "util", "utils", "helper", "helpers", "common"})
        EXPECT_NE(stem, vague) << source;
      if (source.extension() == ".h") {
        std::ifstream header(source);
        const std::string text((std::istreambuf_iterator<char>(header)), std::istreambuf_iterator<char>());
        EXPECT_NE(text.find("#pragma once"), std::string::npos) << source;
        EXPECT_EQ(text.rfind("//", 0), 0u) << source << " should open with what it is";
      }
    }
  }
}

// They are left out where threads are checked.
TEST(Layout, TestsThatAreSaidToBePureHaveNoThreads) {
  int pure = 0;
  for (const fs::directory_entry& folder : fs::directory_iterator(kRoot / "tests")) {
    std::ifstream lists(folder.path() / "CMakeLists.txt");
    for (std::string line; std::getline(lists, line);) {
      const size_t sources = line.find(" SOURCES ");
      if (line.find(" PURE ") == std::string::npos || sources == std::string::npos) continue;
      ++pure;
      const fs::path source = folder.path() / line.substr(sources + 9, line.find(')') - sources - 9);
      std::ifstream file(source);
      const std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
      ASSERT_FALSE(text.empty()) << source;
      for (const char* threads : {"<thread>", "<mutex>", "<atomic>", "base/mutex.h", "paced_thread.h", "jobs = "})
        EXPECT_EQ(text.find(threads), std::string::npos) << source << " has " << threads;
    }
  }
  EXPECT_GT(pure, 20);  // the reader of lists works
}

}  // namespace
