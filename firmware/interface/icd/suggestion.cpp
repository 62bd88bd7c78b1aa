#include "icd/suggestion.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

#include "icd/scoring.hpp"
#include "icd/sentence.hpp"
#include "icd/text.hpp"

namespace adit::icd {
namespace {

/// Letters to insert, leave out or replace (Levenshtein).
std::size_t distance(std::string_view from, std::string_view to) {
  std::vector<std::size_t> row(to.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= from.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= to.size(); ++j) {
      const std::size_t replaced = diagonal + (from[i - 1] == to[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row.back();
}

bool share_beginning(std::string_view a, std::string_view b) {
  static constexpr std::size_t kTelling = 3;
  if (std::min(a.size(), b.size()) < kTelling) return false;
  return a.starts_with(b) || b.starts_with(a);
}

/// The letters of `text` in lower case.
std::string letters_of(std::string_view text) {
  std::string letters;
  for (const char each : text) {
    if (const char letter = lower(each); letter >= 'a' && letter <= 'z') letters += letter;
  }
  return letters;
}

bool is_part(std::string_view one, std::string_view other) {
  constexpr std::size_t kTelling = 3;  // letters
  return std::min(one.size(), other.size()) >= kTelling && (one.contains(other) || other.contains(one));
}

}  // namespace

std::optional<std::string_view> nearest(std::string_view word, std::span<const std::string_view> known,
                                        std::size_t few) {
  static constexpr std::size_t kLongest = 64;  // no word is that long, and a hostile one costs nothing
  if (word.size() > kLongest) return std::nullopt;
  std::optional<std::string_view> best;
  std::size_t least = std::max(few, word.size() / 3) + 1;
  for (const std::string_view candidate : known) {
    const std::size_t apart = share_beginning(word, candidate) ? 1 : distance(word, candidate);
    if (apart < least && apart < candidate.size()) {
      least = apart;
      best = candidate;
    }
  }
  return best;
}

std::string did_you_mean(std::string_view word, std::span<const std::string_view> known) {
  const auto meant = nearest(word, known);
  return meant ? sentence("; did you mean ", *meant, "?") : "";
}

std::string type_hint(std::string_view type) {
  const std::string word = letters_of(type);
  for (const std::string_view known : kArtifactTypes) {
    const std::string letters = letters_of(known);
    const std::string_view only[] = {letters};
    if (is_part(word, letters) || nearest(word, only, 0)) return sentence("; did you mean ", known, "?");
  }
  return "";
}

}  // namespace adit::icd
