#include "runtime/app/importance_file.h"

#include <gtest/gtest.h>

namespace belvedere {
namespace {

TEST(ImportanceFile, RulesAreRead) {
  const auto table =
      ParseImportance("[[rule]]\nvalue = 0.9\nopposing = [0.5, 1, 1, 2]\nspeed = [100, 250, 1e9, 1e9]\n", "i.toml");
  ASSERT_TRUE(table.ok()) << table.message();
  ImportanceFacts facts{};
  EXPECT_EQ(table->Of(facts), kUsualImportance);
  facts[static_cast<size_t>(ImportanceInput::kOpposing)] = 1;
  facts[static_cast<size_t>(ImportanceInput::kSpeed)] = 300;
  EXPECT_EQ(table->Of(facts), 0.9);
}

TEST(ImportanceFile, MistakesAreNamed) {
  const auto complaint = [](const char* text) { return ParseImportance(text, "i.toml").message(); };
  EXPECT_NE(complaint("[[rule]]\nspeed = [0, 0, 1, 1]\n").find("value is missing"), std::string::npos);
  EXPECT_NE(complaint("[[rule]]\nvalue = 1\nspeed = [0, 1]\n").find("speed must be an array of 4 numbers"),
            std::string::npos);
  EXPECT_NE(complaint("[[rule]]\nvalue = 1\nspeed = [3, 2, 1, 0]\n").find("must rise"), std::string::npos);
  EXPECT_NE(complaint("[[rule]]\nvalue = 1\nsped = [0, 0, 1, 1]\n").find("did you mean speed"), std::string::npos);
  EXPECT_FALSE(LoadImportance("/nowhere/i.toml").ok());
}

TEST(ImportanceFile, TheProjectsOwnTableIsRight) {
  const auto table = LoadImportance(std::string(BELVEDERE_SOURCE_DIR) + "/servers/models/importance.toml");
  ASSERT_TRUE(table.ok()) << table.message();
  ImportanceFacts near{}, far{};
  far[static_cast<size_t>(ImportanceInput::kDistance)] = 1e9;
  far[static_cast<size_t>(ImportanceInput::kNeutral)] = near[static_cast<size_t>(ImportanceInput::kNeutral)] = 1;
  EXPECT_EQ(table->Of(near), 1.0);
  EXPECT_LT(table->Of(far), kUsualImportance);
}

}  // namespace
}  // namespace belvedere
