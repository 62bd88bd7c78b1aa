#include "icd/bearer_token.hpp"

#include <algorithm>

namespace adit::icd {
namespace {

constexpr std::size_t kLongest = 256;

}  // namespace

std::optional<BearerToken> BearerToken::parse(std::string_view text) {
  const auto visible = [](char letter) { return letter > 0x20 && letter < 0x7f; };
  if (text.empty() || text.size() > kLongest || !std::ranges::all_of(text, visible)) return std::nullopt;
  return BearerToken(std::string(text));
}

bool BearerToken::matches(std::string_view presented) const {
  unsigned difference = presented.size() == text_.size() ? 0 : 1;
  for (std::size_t i = 0; i < text_.size(); ++i) {
    const char other = presented.empty() ? '\0' : presented[i % presented.size()];
    difference |= static_cast<unsigned char>(text_[i]) ^ static_cast<unsigned char>(other);
  }
  return difference == 0;
}

void BearerToken::strike_from(std::string& text) const {
  constexpr std::string_view kStruck = "[token]";
  constexpr std::size_t kShortest = 4;
  if (text_.size() < kShortest) return;
  for (std::size_t at = 0; (at = text.find(text_, at)) != std::string::npos; at += kStruck.size()) {
    text.replace(at, text_.size(), kStruck);
  }
}

bool same(const std::optional<BearerToken>& one, const std::optional<BearerToken>& other) {
  return one && other ? one->matches(other->reveal()) : one.has_value() == other.has_value();
}

std::string_view token_in(std::string_view authorization) {
  constexpr std::string_view kBlanks = " \t";
  const auto start = authorization.find_first_not_of(kBlanks);
  if (start == std::string_view::npos) return {};
  authorization.remove_prefix(start);
  authorization = authorization.substr(0, authorization.find_last_not_of(kBlanks) + 1);

  constexpr std::string_view kScheme = "bearer";
  const auto same_letter = [](char wanted, char given) { return wanted == (given | 0x20); };
  if (authorization.size() <= kScheme.size() ||
      !std::ranges::equal(kScheme, authorization.substr(0, kScheme.size()), same_letter)) {
    return {};
  }
  authorization.remove_prefix(kScheme.size());
  if (kBlanks.find(authorization.front()) == std::string_view::npos) return {};
  authorization.remove_prefix(authorization.find_first_not_of(kBlanks));
  return authorization;
}

}  // namespace adit::icd
