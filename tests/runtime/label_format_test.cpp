#include "runtime/scene/label_format.h"

#include "runtime/earth/ellipsoid.h"

#include <gtest/gtest.h>

namespace belvedere {
namespace {

class LabelFormatTest : public testing::Test {
 protected:
  LabelFormatTest() {
    record_.id = {1, 2, 3};
    record_.type = {1, 2, 225, 57, 0, 0, 0};
    record_.force = 2;
  }
  std::string Write(const std::string& format) {
    LabelFacts facts{record_, "airliner", 37, -118, 10'668, 100.0 * LevelAxesAt(37, -118).east};
    return LabelFormat::Parse(format)->Write(facts);
  }
  ObjectRecord record_;
};

TEST_F(LabelFormatTest, TheUsualOneNamesAircraftWithTheirFlightLevel) {
  EXPECT_EQ(Write("{marking} {level}"), "1:2:3 FL350");
  record_.marking = Marking::Sanitise(std::string_view("UAL123"));
  EXPECT_EQ(Write("{marking} {level}"), "UAL123 FL350");
  EXPECT_EQ(LabelFormat().Write({record_, "", 0, 0, 10'668, {}}), "UAL123 FL350");
  record_.type.domain = 1;
  EXPECT_EQ(Write("{marking} {level}"), "UAL123");
}

TEST_F(LabelFormatTest, FieldsAreWhatTheySay) {
  EXPECT_EQ(Write("{id}|{type}|{model}|{force}"), "1:2:3|1.2.225.57.0.0.0|airliner|HOSTILE");
  EXPECT_EQ(Write("{altitude} ft {altitude_m} m"), "35000 ft 10668 m");
  EXPECT_EQ(Write("{speed} kt {speed_mps} m/s {heading}"), "194 kt 100 m/s 090");
  EXPECT_EQ(Write("{damage}"), "");
  record_.appearance = 3 << 3;
  EXPECT_EQ(Write("{damage}"), "destroyed");
}

TEST_F(LabelFormatTest, LinesWithoutAnythingAreLeftOut) {
  EXPECT_EQ(Write("{marking}\\n{damage}\\n  {speed} \\n"), "1:2:3\n194");
  EXPECT_EQ(Write(""), "");
}

TEST_F(LabelFormatTest, AFieldThatIsNotKnownIsNamed) {
  EXPECT_NE(LabelFormat::Parse("{speeed}").message().find("\"speeed\" is no field of a label; there are {marking}"),
            std::string::npos);
  EXPECT_FALSE(LabelFormat::Parse("{speed").ok());
}

TEST_F(LabelFormatTest, TheSizeIsToldBeforeItIsWritten) {
  record_.marking = Marking::Sanitise(std::string_view("UAL123"));
  const auto format = LabelFormat::Parse("{marking} {level}\\n{damage}\\n{speed} kt");
  const LabelSize size = format->SizeFor(record_);
  EXPECT_EQ(size.lines, 2);
  EXPECT_EQ(size.characters, 12);
  EXPECT_EQ(SizeOf(Write("{marking} {level}\\n{damage}\\n{speed} kt")).characters, 12);
}

}  // namespace
}  // namespace belvedere
