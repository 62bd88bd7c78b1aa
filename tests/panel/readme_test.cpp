#include <gtest/gtest.h>

#include "panel/drawing.hpp"
#include "panel/states.hpp"
#include "project_files.hpp"

namespace adit::panel {
namespace {

std::string table_of_states() {
  std::string text = "| state | health | scoring | mapping | attention | what it says |\n";
  text += "| --- | --- | --- | --- | --- | --- |\n";
  for (const StateRow& row : state_table()) {
    text.append("| ").append(row.name).append(" |");
    for (const auto& pattern : row.patterns) {
      text.append(" ").append(pattern ? name_of(*pattern) : "").append(pattern ? " |" : "|");
    }
    text.append(" ").append(row.meaning).append(" |\n");
  }
  return text;
}

TEST(PanelReadme, HasTheTableOfTheStates) {
  EXPECT_NE(project_text("firmware/doors/panel/README.md").find(table_of_states()), std::string::npos)
      << "put this table into firmware/doors/panel/README.md:\n"
      << table_of_states();
}

TEST(PanelReadme, DrawsThePatterns) {
  EXPECT_NE(project_text("firmware/doors/panel/README.md").find("](patterns.svg)"), std::string::npos);
  EXPECT_TRUE(project_text("firmware/doors/panel/patterns.svg") == drawing())
      << "put this into firmware/doors/panel/patterns.svg:\n"
      << drawing();
}

TEST(PanelReadme, HasARowForEachPattern) {
  for (const Pattern pattern : kPatterns) {
    EXPECT_NE(
        project_text("firmware/doors/panel/README.md").find("\n| " + std::string(name_of(pattern)) + " | "),
        std::string::npos)
        << name_of(pattern);
  }
}

}  // namespace
}  // namespace adit::panel
