#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "panel/drawing.hpp"
#include "panel/states.hpp"

namespace adit::panel {
namespace {

std::string text_of(const std::string& name) {
  std::ifstream stream(ADIT_SOURCE_DIR "/firmware/panel/" + name);
  return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(PanelReadme, HasTheTableOfTheStates) {
  EXPECT_NE(text_of("README.md").find(state_table_text()), std::string::npos)
      << "put this table into firmware/panel/README.md:\n"
      << state_table_text();
}

TEST(PanelReadme, DrawsThePatternsAsTheyAre) {
  EXPECT_NE(text_of("README.md").find("](patterns.svg)"), std::string::npos);
  EXPECT_TRUE(text_of("patterns.svg") == drawing()) << "put this into firmware/panel/patterns.svg:\n"
                                                    << drawing();
}

TEST(PanelReadme, HasARowForEachPattern) {
  for (const Pattern pattern : kPatterns) {
    EXPECT_NE(text_of("README.md").find("\n| " + std::string(name_of(pattern)) + " | "), std::string::npos)
        << name_of(pattern);
  }
}

}  // namespace
}  // namespace adit::panel
