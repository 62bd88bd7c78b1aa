#include "rehearsal/robots/style.hpp"

namespace adit::robots {

std::optional<TeamStyle> TeamStyle::parse(std::string_view name) {
  if (name == "mixed") return TeamStyle();
  for (std::size_t i = 0; i < kStyles.size(); ++i) {
    if (kStyles[i].name == name) return TeamStyle(i);
  }
  return std::nullopt;
}

}  // namespace adit::robots
