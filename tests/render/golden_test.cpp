// Golden images: small pictures of a made Earth, drawn off-screen and held against the ones in golden/.
//
// Tolerance: the mean difference of a channel is at most kMeanTolerance of 255, and at most kOutlierShare of the pixels
// differ by more than kOutlier in a channel (renderers round edges differently). After a change that is meant, look at
// the new pictures and write them: BELVEDERE_WRITE_GOLDEN=1 build/bin/golden_test

#include "render/image_file.h"
#include "render/renderer.h"
#include "tests/render/on_stage.h"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <string>

namespace belvedere::testing {
namespace {

constexpr int kWidth = 160, kHeight = 120;
constexpr double kMeanTolerance = 2.0;
constexpr int kOutlier = 24;
constexpr double kOutlierShare = 0.01;

double Hills(double latitude_deg, double longitude_deg) {
  return 500 + 300 * std::sin(latitude_deg * 400) * std::cos(longitude_deg * 300) + 40 * std::sin(longitude_deg * 2000);
}

std::vector<uint8_t> ReadGolden(const std::string& path) {
  const auto file = OIIO::ImageInput::open(path);
  if (!file) return {};
  const OIIO::ImageSpec& spec = file->spec();
  std::vector<uint8_t> rgb(static_cast<size_t>(spec.width) * static_cast<size_t>(spec.height) * 3);
  if (spec.nchannels != 3 || !file->read_image(0, 0, 0, 3, OIIO::TypeDesc::UINT8, rgb.data())) return {};
  return rgb;
}

void ExpectGolden(const Picture& picture, const std::string& name) {
  const std::string path = std::string(BELVEDERE_SOURCE_DIR) + "/tests/render/golden/" + name + ".png";
  if (std::getenv("BELVEDERE_WRITE_GOLDEN") != nullptr) {
    ASSERT_TRUE(WritePng(path, picture.width_px, picture.height_px, picture.rgb).ok());
  }
  const std::vector<uint8_t> golden = ReadGolden(path);
  ASSERT_EQ(golden.size(), picture.rgb.size()) << path << " is not there or of another size";
  double sum = 0;
  size_t outliers = 0;
  for (size_t pixel = 0; pixel < golden.size() / 3; ++pixel) {
    int most = 0;
    for (size_t i = 3 * pixel; i < 3 * pixel + 3; ++i) {
      const int difference = std::abs(int{golden[i]} - int{picture.rgb[i]});
      sum += difference;
      most = std::max(most, difference);
    }
    outliers += most > kOutlier ? 1 : 0;
  }
  EXPECT_LE(sum / static_cast<double>(golden.size()), kMeanTolerance) << name;
  EXPECT_LE(static_cast<double>(outliers), kOutlierShare * static_cast<double>(golden.size() / 3)) << name;
}

class Golden : public OnStage {
 protected:
  void SetUp() override { Open(24); }

  // Nine quadnodes of hills, chequered, half of them under a relief.
  Picture Draw(ViewParameters view) {
    const std::vector<Quadcode> nodes = Block(10, 10, 10, 3);
    for (size_t i = 0; i < nodes.size(); ++i) {
      scene_.AddTerrain(nodes[i], Hills);
      Load(scene_.AddColourOf(nodes[i], [](double u, double v) {
        const bool light = (static_cast<int>(std::floor(u * 8)) + static_cast<int>(std::floor(v * 8))) % 2 == 0;
        return light ? Rgba{120, 150, 80, 255} : Rgba{90, 110, 60, 255};
      }));
      if (i % 2 == 0) Load(scene_.AddOverlay(nodes[i], 150));
    }
    view.sky = true;
    stage_->channel->parameters.Publish(view);
    DisplayList& list = stage_->channel->terrain_lists.back();
    list.Clear();
    AddSurface(list, scene_, nodes, 2);
    stage_->channel->terrain_lists.Publish();
    stage_->Frame();
    return stage_->Take();
  }
  void Load(PagePin pin) {
    std::vector<PagePin> pins;
    pins.push_back(std::move(pin));
    stage_->Upload(std::move(pins));
  }
};

TEST_F(Golden, HillsFromAnAircraft) {
  ExpectGolden(Draw(LookAt({9.95, 9.98, 3000}, 30, -18, kWidth, kHeight)), "hills");
}

TEST_F(Golden, HillsInTheEvening) {
  ViewParameters view = LookAt({9.95, 9.98, 3000}, 30, -18, kWidth, kHeight);
  view.utc_s += 5.4 * 3600;
  ExpectGolden(Draw(view), "evening");
}

TEST_F(Golden, TheLimbOfTheEarthFromOrbit) {
  ExpectGolden(Draw(LookAt({0, -10, 400'000}, 60, -15, kWidth, kHeight)), "orbit");
}

}  // namespace
}  // namespace belvedere::testing
