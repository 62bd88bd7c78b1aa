#include <gtest/gtest.h>

#include "icd/scoring.hpp"
#include "icd/suggestion.hpp"

namespace adit::icd {
namespace {

TEST(TypeHint, SuggestsASimilarType) {
  const struct {
    std::string_view type, meant;
  } rows[] = {{"Cellphone", "Cell Phone"},
              {"CELL_PHONE", "Cell Phone"},
              {"Phone", "Cell Phone"},
              {"Fire_Extinguisher", "Fire Extinguisher"},
              {"fire extinguiser", "Fire Extinguisher"},
              {"extinguisher", "Fire Extinguisher"},
              {"Backpack ", "Backpack"},
              {"bakpak", "Backpack"},
              {"Surviver", "Survivor"},
              {"survivors", "Survivor"},
              {"Ropes", "Rope"},
              {"cube_2", "Cube"},
              {"Gaz", "Gas"},
              {"vant", "Vent"}};
  for (const auto& [type, meant] : rows)
    EXPECT_EQ(type_hint(type), "; did you mean " + std::string(meant) + "?") << type;
  for (const std::string_view known : kArtifactTypes)
    EXPECT_EQ(type_hint(known), "; did you mean " + std::string(known) + "?");
}

TEST(TypeHint, IsEmptyIfNoTypeIsSimilar) {
  for (const std::string_view type :
       {"", " ", "as", "test", "Radio", "Toolbox", "12345", "gate", "hope chest", "\xff"})
    EXPECT_EQ(type_hint(type), "") << type;
}

}  // namespace
}  // namespace adit::icd
