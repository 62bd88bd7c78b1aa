#include "icd/scoring.hpp"

#include "icd/text.hpp"

namespace adit::icd {

std::string_view artifact_type(std::string_view text) {
  for (const std::string_view type : kArtifactTypes) {
    if (same_but_for_case(type, text)) return type;
  }
  return {};
}

}  // namespace adit::icd
