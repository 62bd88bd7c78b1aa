#include "intake/type_hint.hpp"

#include <algorithm>

#include "icd/scoring.hpp"
#include "icd/sentence.hpp"
#include "icd/suggestion.hpp"
#include "icd/text.hpp"

namespace adit::intake {
namespace {

/// The letters of `text` in lower case.
std::string letters_of(std::string_view text) {
  std::string letters;
  for (const char each : text) {
    if (const char letter = icd::lower(each); letter >= 'a' && letter <= 'z') letters += letter;
  }
  return letters;
}

bool is_part(std::string_view one, std::string_view other) {
  constexpr std::size_t kTelling = 3;  // letters
  return std::min(one.size(), other.size()) >= kTelling && (one.contains(other) || other.contains(one));
}

}  // namespace

std::string type_hint(std::string_view type) {
  const std::string word = letters_of(type);
  for (const std::string_view known : icd::kArtifactTypes) {
    const std::string letters = letters_of(known);
    const std::string_view only[] = {letters};
    if (is_part(word, letters) || icd::nearest(word, only, 0))
      return icd::sentence("; did you mean ", known, "?");
  }
  return "";
}

}  // namespace adit::intake
