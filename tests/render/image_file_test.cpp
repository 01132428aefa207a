#include "render/image_file.h"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <vector>

namespace belvedere {
namespace {

class ImageFile : public ::testing::Test {
 protected:
  ImageFile() {
    folder_ = std::filesystem::temp_directory_path() /
              ("belvedere_image_" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  ~ImageFile() override { std::filesystem::remove_all(folder_); }
  std::string Path(const char* name) const { return (folder_ / name).string(); }
  static std::vector<char> Bytes(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  size_t Files() const { return static_cast<size_t>(std::distance(std::filesystem::directory_iterator(folder_), {})); }
  std::filesystem::path folder_;
};

TEST_F(ImageFile, PngComesBackAsItWas) {
  const std::vector<uint8_t> rgb = {255, 0, 0, 0, 255, 0, 0, 0, 255, 1, 2, 3, 100, 150, 200, 255, 255, 255};
  ASSERT_TRUE(WritePng(Path("a.png"), 3, 2, rgb).ok());
  const auto input = OIIO::ImageInput::open(Path("a.png"));
  ASSERT_TRUE(input);
  EXPECT_EQ(input->spec().width, 3);
  EXPECT_EQ(input->spec().height, 2);
  std::vector<uint8_t> read(rgb.size());
  ASSERT_TRUE(input->read_image(0, 0, 0, 3, OIIO::TypeDesc::UINT8, read.data()));
  EXPECT_EQ(read, rgb);
  EXPECT_EQ(Files(), 1U);
}

TEST_F(ImageFile, DepthComesBackAsItWas) {
  const std::vector<float> depth = {1.5F, 6378137.25F, std::numeric_limits<float>::infinity(), 0.001F};
  ASSERT_TRUE(WriteDepthExr(Path("a.exr"), 2, 2, depth).ok());
  const auto input = OIIO::ImageInput::open(Path("a.exr"));
  ASSERT_TRUE(input);
  ASSERT_EQ(input->spec().nchannels, 1);
  EXPECT_EQ(input->spec().channelnames[0], "Z");
  std::vector<float> read(depth.size());
  ASSERT_TRUE(input->read_image(0, 0, 0, 1, OIIO::TypeDesc::FLOAT, read.data()));
  EXPECT_EQ(read, depth);
}

TEST_F(ImageFile, TheSamePixelsGiveTheSameBytes) {
  const std::vector<uint8_t> rgb(3 * 64 * 64, 77);
  const std::vector<float> depth(64 * 64, 12.5F);
  ASSERT_TRUE(WritePng(Path("a.png"), 64, 64, rgb).ok());
  ASSERT_TRUE(WritePng(Path("b.png"), 64, 64, rgb).ok());
  ASSERT_TRUE(WriteDepthExr(Path("a.exr"), 64, 64, depth).ok());
  ASSERT_TRUE(WriteDepthExr(Path("b.exr"), 64, 64, depth).ok());
  EXPECT_EQ(Bytes(Path("a.png")), Bytes(Path("b.png")));
  EXPECT_EQ(Bytes(Path("a.exr")), Bytes(Path("b.exr")));
}

TEST_F(ImageFile, AFolderThatIsNotThereGivesOneLine) {
  const Status status = WritePng(Path("no/such/a.png"), 1, 1, std::vector<uint8_t>(3));
  ASSERT_FALSE(status.ok());
  EXPECT_NE(status.message().find("no/such/a.png"), std::string::npos);
  EXPECT_EQ(status.message().find('\n'), std::string::npos);
}

}  // namespace
}  // namespace belvedere
