#include "icd/artifact_report.hpp"

#include <algorithm>

namespace adit::icd {
namespace {

char lower(char letter) {
  return letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter;
}

bool same_but_for_case(std::string_view a, std::string_view b) {
  return std::ranges::equal(a, b, {}, lower, lower);
}

}  // namespace

std::string_view artifact_type(std::string_view text) {
  for (const std::string_view type : kArtifactTypes) {
    if (same_but_for_case(type, text)) return type;
  }
  return {};
}

}  // namespace adit::icd
