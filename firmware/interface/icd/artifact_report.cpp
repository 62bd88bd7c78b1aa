#include "icd/artifact_report.hpp"

#include "icd/letter_case.hpp"

namespace adit::icd {

std::string_view artifact_type(std::string_view text) {
  for (const std::string_view type : kArtifactTypes) {
    if (same_but_for_case(type, text)) return type;
  }
  return {};
}

}  // namespace adit::icd
