#include "runtime/paging/store_mapping.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

namespace belvedere {
namespace {

// A file of 32 MiB, mapped and touched.
class StoreMappingTest : public testing::Test {
 protected:
  StoreMappingTest() {
    std::ofstream(path_, std::ios::binary) << std::string(kBytes, 'x');
    const int file = open(path_.c_str(), O_RDONLY);
    mapped_ = static_cast<const char*>(mmap(nullptr, kBytes, PROT_READ, MAP_SHARED, file, 0));
    close(file);
  }
  ~StoreMappingTest() override {
    munmap(const_cast<char*>(mapped_), kBytes);
    unlink(path_.c_str());
  }

  int64_t Touch() const {
    int64_t sum = 0;
    for (size_t at = 0; at < kBytes; at += 4096) sum += mapped_[at];
    return sum;
  }
  // Bytes of the mapping that count as the process's memory.
  static size_t ResidentFileBytes() {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);) {
      if (line.starts_with("RssFile:")) return std::stoull(line.substr(8)) * 1024;
    }
    return 0;
  }

  static constexpr size_t kBytes = size_t{32} << 20;
  const std::string path_ = testing::TempDir() + "store_mapping_test." + std::to_string(getpid());
  const char* mapped_ = nullptr;
};

TEST_F(StoreMappingTest, GivesBackWhatWasRead) {
  const int64_t sum = Touch();
  const size_t touched = ResidentFileBytes();
  StoreMapping mapping;
  mapping.Find(mapped_ + 12'345);
  mapping.HaveRead(1000);
  EXPECT_GE(ResidentFileBytes() + (kBytes / 4), touched) << "too little was read to be worth it";
  mapping.HaveRead(kBytes);
  EXPECT_LT(ResidentFileBytes() + (kBytes / 2), touched);
  EXPECT_EQ(Touch(), sum) << "and it can be read again";
}

TEST_F(StoreMappingTest, AnUnknownMappingIsLeftAlone) {
  Touch();
  const size_t touched = ResidentFileBytes();
  const StoreMapping mapping;
  mapping.HaveRead(kBytes);
  EXPECT_GE(ResidentFileBytes() + (kBytes / 4), touched);
}

}  // namespace
}  // namespace belvedere
