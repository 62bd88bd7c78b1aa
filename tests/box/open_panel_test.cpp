#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "box/lights.hpp"
#include "box/this_box.hpp"

namespace adit::box {
namespace {

using testing::HasSubstr;

class OpenPanelTest : public testing::Test {
 protected:
  OpenPanelTest() {
    std::string name = (std::filesystem::temp_directory_path() / "adit-open-panel-XXXXXX").string();
    folder_ = mkdtemp(name.data());
  }
  ~OpenPanelTest() override { std::filesystem::remove_all(folder_); }
  std::string board(std::string_view text) const {
    std::ofstream(folder_ / "board.json") << text;
    return (folder_ / "board.json").string();
  }
  std::filesystem::path folder_;
};

TEST_F(OpenPanelTest, SimulatesThePanelWithoutNamedLines) {
  const panel::PanelDevices opened = open_panel({}, {.socket = "", .folder = folder_.string()});
  ASSERT_TRUE(opened.lines->set({true, false, false, false}).has_value());
  EXPECT_TRUE(std::filesystem::exists(folder_ / "panel"));
  ASSERT_NE(opened.button, nullptr);
  EXPECT_TRUE(std::filesystem::is_fifo(folder_ / "panel.button"));
}

TEST_F(OpenPanelTest, SimulatesLightsButNoButtonIfLinesFail) {
  settings::Panel settings;
  settings.chip = std::string("no-such-chip");  // GCC 12 warns of a plain literal here
  settings.health = "H";
  for (const std::string button : {"", "B"}) {
    settings.button = button;
    const panel::PanelDevices opened = open_panel(settings, {.socket = "", .folder = folder_.string()});
    EXPECT_EQ(opened.lines->set({true, false, false, false}).error(),
              "panel: chip no-such-chip: No such file or directory");
    EXPECT_TRUE(std::filesystem::exists(folder_ / "panel"));
    EXPECT_EQ(opened.button == nullptr, button.empty());
    if (opened.button) EXPECT_FALSE(opened.button->is_pressed().has_value());
    EXPECT_FALSE(std::filesystem::exists(folder_ / "panel.button"))
        << "a simulated button proves no presence";
  }
}

TEST_F(OpenPanelTest, WorksWithoutABoard) {
  for (const char* const file : {"", "/absent/board.json"}) {
    const KnownBoard known = read_board(file);
    EXPECT_EQ(known.board.name, "");
    EXPECT_EQ(known.trouble, "");
  }
}

TEST_F(OpenPanelTest, ReadsTheBoard) {
  const KnownBoard known = read_board(board(R"({"name": "b", "title": "B", "panel": {"health": "H"}})"));
  EXPECT_EQ(known.trouble, "");
  EXPECT_EQ(known.board.name, "b");
  EXPECT_EQ(known.board.panel->health, "H");
}

TEST_F(OpenPanelTest, ReportsAndIgnoresAnInvalidBoard) {
  const std::string file = board(R"({"name": "b", "title": "B", "panel": {"helth": "H"}})");
  const KnownBoard known = read_board(file);
  EXPECT_EQ(known.board.name, "");
  EXPECT_FALSE(known.board.panel);
  EXPECT_THAT(known.trouble, HasSubstr(file));
  EXPECT_THAT(known.trouble, HasSubstr(": panel.helth: no such key; did you mean health?"));
}

}  // namespace
}  // namespace adit::box
