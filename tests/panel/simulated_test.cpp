#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "panel/lines.hpp"

namespace adit::panel {
namespace {

class SimulatedLights : public testing::Test {
 protected:
  SimulatedLights() {
    std::string name = (std::filesystem::temp_directory_path() / "adit-panel-XXXXXX").string();
    folder_ = mkdtemp(name.data());
  }
  ~SimulatedLights() override { std::filesystem::remove_all(folder_); }
  std::string shown() const {
    std::ifstream stream(folder_ / "panel");
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  std::filesystem::path folder_;
};

TEST_F(SimulatedLights, WritesTheLitLights) {
  const auto lines = make_simulated_lines(folder_ / "panel");
  ASSERT_TRUE(lines->set({true, false, true, false}).has_value());
  EXPECT_EQ(shown(), "health on\nscoring off\nmapping on\nattention off\n");
  ASSERT_TRUE(lines->set({false, true, false, true}).has_value());
  EXPECT_EQ(shown(), "health off\nscoring on\nmapping off\nattention on\n");
}

TEST_F(SimulatedLights, ReplacesTheFileAtomically) {
  const auto lines = make_simulated_lines(folder_ / "panel");
  ASSERT_TRUE(lines->set({true, true, true, true}).has_value());
  std::ifstream reader(folder_ / "panel");
  ASSERT_TRUE(lines->set({false, false, false, false}).has_value());
  const std::string seen(std::istreambuf_iterator<char>(reader), {});
  EXPECT_EQ(seen, "health on\nscoring on\nmapping on\nattention on\n");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_), {}), 1);
}

TEST_F(SimulatedLights, WritesOnlyChanges) {
  const auto lines = make_simulated_lines(folder_ / "panel");
  ASSERT_TRUE(lines->set({true, false, false, false}).has_value());
  std::filesystem::remove(folder_ / "panel");
  ASSERT_TRUE(lines->set({true, false, false, false}).has_value());
  EXPECT_FALSE(std::filesystem::exists(folder_ / "panel"));
  ASSERT_TRUE(lines->set({true, true, false, false}).has_value());
  EXPECT_TRUE(std::filesystem::exists(folder_ / "panel"));
}

TEST_F(SimulatedLights, IsDarkAtTheEnd) {
  ASSERT_TRUE(make_simulated_lines(folder_ / "panel")->set({true, true, true, true}).has_value());
  EXPECT_EQ(shown(), "health off\nscoring off\nmapping off\nattention off\n");
}

TEST_F(SimulatedLights, ReportsAWriteErrorAndRetries) {
  const auto lines = make_simulated_lines(folder_ / "later/panel");
  const auto set = lines->set({true, false, false, false});
  ASSERT_FALSE(set.has_value());
  EXPECT_EQ(set.error(), "panel: " + (folder_ / "later/panel").string() + ": No such file or directory");
  std::filesystem::create_directory(folder_ / "later");
  EXPECT_TRUE(lines->set({true, false, false, false}).has_value());
  EXPECT_TRUE(std::filesystem::exists(folder_ / "later/panel"));
}

}  // namespace
}  // namespace adit::panel
