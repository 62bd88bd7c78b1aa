#include <gtest/gtest.h>

#include "panel/drawing.hpp"
#include "panel/states.hpp"
#include "project_files.hpp"

namespace adit::panel {
namespace {

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
