#include "settings/board.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "project_files.hpp"

namespace adit::settings {
namespace {

using testing::ElementsAre;

std::vector<std::string> board_errors_of(const std::string& json) {
  const auto board = parse_board(json);
  std::vector<std::string> sentences;
  if (board) return sentences;
  for (const Error& error : board.error()) sentences.push_back(error.sentence());
  return sentences;
}

std::string with(const std::string& more) {
  return R"({"name": "qemu-virt", "title": "QEMU's virt machine")" + more + "}";
}

TEST(Board, HasATitleAndAPanel) {
  const auto board = parse_board(with(R"(, "panel": {"chip": "pl061", "health": "H", "scoring": "S",
      "mapping": "M", "attention": "A", "active_low": true, "button": "B", "button_active_low": false})"));
  ASSERT_TRUE(board) << sentence_of(board.error());
  EXPECT_EQ(board->name, "qemu-virt");
  EXPECT_EQ(board->title, "QEMU's virt machine");
  ASSERT_TRUE(board->panel);
  EXPECT_EQ(board->panel->chip, "pl061");
  EXPECT_EQ(board->panel->health, "H");
  EXPECT_EQ(board->panel->scoring, "S");
  EXPECT_EQ(board->panel->mapping, "M");
  EXPECT_EQ(board->panel->attention, "A");
  EXPECT_TRUE(board->panel->active_low);
  EXPECT_EQ(board->panel->button, "B");
  EXPECT_FALSE(board->panel->button_active_low);
}

TEST(Board, WithoutAPanelUsesTheSettings) {
  const auto board = parse_board(with(""));
  ASSERT_TRUE(board);
  EXPECT_FALSE(board->panel);
}

TEST(Board, MayNameLinesWithoutAChip) {
  const auto board = parse_board(with(R"(, "panel": {"health": "H"})"));
  ASSERT_TRUE(board) << sentence_of(board.error());
  EXPECT_EQ(board->panel->chip, "");
  EXPECT_TRUE(board->panel->has_lights());
  EXPECT_FALSE(board->panel->is_simulated());
}

struct BoardCase {
  std::string json, sentence;
};

const BoardCase kBoardCases[] = {
    {"", "not well-formed JSON at byte 0: "},
    {"[]", "expected an object, got an array"},
    {R"({"title": "T"})", "name: missing; expected 1 to 32 small letters, digits, hyphens and underscores"},
    {R"({"name": "n"})", "title: missing; expected 1 to 80 printable ASCII characters"},
    {R"({"name": "", "title": "T"})",
     "name: expected 1 to 32 small letters, digits, hyphens and underscores, got \"\""},
    {R"({"name": "../x", "title": "T"})",
     "name: expected 1 to 32 small letters, digits, hyphens and underscores, got \"../x\""},
    {R"({"name": 7, "title": "T"})",
     "name: expected 1 to 32 small letters, digits, hyphens and underscores, got 7"},
    {R"({"name": "n", "title": "\u001b[2J"})",
     "title: expected 1 to 80 printable ASCII characters, got \"\\u001b[2J\""},
    {R"({"name": "n", "name": "m", "title": "T"})", "name: given twice"},
    {with(R"(, "panle": {})"), "panle: no such key; did you mean panel? (keys here: name, title, panel)"},
    {with(R"(, "panel": [])"), "panel: expected an object, got an array"},
    {with(R"(, "panel": {"chip": "c"})"),
     "panel.chip: names a chip, but neither a light nor the button has a line"},
    {with(R"(, "panel": {"health": "a line"})"),
     "panel.health: expected a GPIO line's name of at most 31 characters, or \"\", got \"a line\""},
    {with(R"(, "panel": {"button_active_low": 1})"),
     "panel.button_active_low: expected true or false, got 1"},
    {with(R"(, "panel": {"health": "H", "button": "H"})"), "panel.button: the same line as panel.health"},
};

TEST(Board, NamesAFaultByItsPath) {
  for (const BoardCase& row : kBoardCases) {
    const auto errors = board_errors_of(row.json);
    ASSERT_EQ(errors.size(), 1u) << row.json << " " << testing::PrintToString(errors);
    EXPECT_EQ(errors.front().substr(0, row.sentence.size()), row.sentence);
    EXPECT_TRUE(row.json.empty() || errors.front() == row.sentence) << errors.front();
  }
}

TEST(Board, ReportsAllFaultsAtOnce) {
  EXPECT_THAT(board_errors_of(R"({"panel": {"active_low": "no", "blink": 1}, "name": "A"})"),
              ElementsAre("panel.active_low: expected true or false, got \"no\"",
                          "panel.blink: no such key (keys here: chip, health, scoring, mapping, attention, "
                          "active_low, button, button_active_low)",
                          "name: expected 1 to 32 small letters, digits, hyphens and underscores, got \"A\"",
                          "title: missing; expected 1 to 80 printable ASCII characters"));
}

TEST(Board, FilesInTheSourceAreValid) {
  int boards = 0;
  for (const auto& folder : std::filesystem::directory_iterator(project_file("board"))) {
    if (!folder.is_directory()) continue;
    const auto board =
        parse_board(project_text("board/" + folder.path().filename().string() + "/board.json"));
    ASSERT_TRUE(board) << folder.path() << ": " << sentence_of(board.error());
    EXPECT_EQ(board->name, folder.path().filename().string());
    ++boards;
  }
  EXPECT_GT(boards, 0);
}

}  // namespace
}  // namespace adit::settings
