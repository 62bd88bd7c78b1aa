#include "update/version.hpp"

#include <algorithm>

#include "icd/text.hpp"

namespace adit::update {
namespace {

constexpr std::string_view kDigits = "0123456789";
constexpr std::string_view kLetters = "0123456789-abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ";

/// Digits without leading zeros.
bool is_number(std::string_view text) {
  return !text.empty() && text.find_first_not_of(kDigits) == std::string_view::npos &&
         (text.size() == 1 || text.front() != '0');
}

std::optional<std::uint64_t> number_in(std::string_view text) {
  return is_number(text) ? icd::number_in<std::uint64_t>(text) : std::nullopt;
}

std::vector<std::string_view> pieces_of(std::string_view text) {
  std::vector<std::string_view> pieces;
  for (std::size_t from = 0;;) {
    const std::size_t dot = text.find('.', from);
    pieces.push_back(text.substr(from, dot - from));
    if (dot == std::string_view::npos) return pieces;
    from = dot + 1;
  }
}

bool is_identifier(std::string_view text) {
  return !text.empty() && text.find_first_not_of(kLetters) == std::string_view::npos;
}

/// "rc" or "1". Numbers have no leading zeros, so equal identifiers are written alike.
bool is_pre_release(std::string_view text) {
  const bool digits = text.find_first_not_of(kDigits) == std::string_view::npos;
  return is_identifier(text) && (!digits || is_number(text));
}

/// Numbers by value, words by ASCII, numbers before words.
std::strong_ordering compare(const std::string& left, const std::string& right) {
  const bool numbers[] = {is_number(left), is_number(right)};
  if (numbers[0] != numbers[1])
    return numbers[0] ? std::strong_ordering::less : std::strong_ordering::greater;
  if (numbers[0] && left.size() != right.size()) return left.size() <=> right.size();
  return left <=> right;
}

}  // namespace

std::optional<Version> Version::parse(std::string_view text) {
  if (text.size() > kLongest) return std::nullopt;
  const std::size_t plus = text.find('+');
  if (plus != std::string_view::npos && !std::ranges::all_of(pieces_of(text.substr(plus + 1)), is_identifier))
    return std::nullopt;
  const std::string_view rest = text.substr(0, plus);
  const std::size_t dash = rest.find('-');
  Version version;
  for (const std::string_view piece : pieces_of(rest.substr(0, dash))) {
    const auto number = number_in(piece);
    if (!number) return std::nullopt;
    version.release_.push_back(*number);
  }
  if (version.release_.size() != 3) return std::nullopt;
  if (dash == std::string_view::npos) return version;
  for (const std::string_view piece : pieces_of(rest.substr(dash + 1))) {
    if (!is_pre_release(piece)) return std::nullopt;
    version.pre_release_.emplace_back(piece);
  }
  return version;
}

std::strong_ordering operator<=>(const Version& left, const Version& right) {
  if (const auto order = left.release_ <=> right.release_; order != 0) return order;
  if (left.pre_release_.empty() != right.pre_release_.empty())
    return left.pre_release_.empty() ? std::strong_ordering::greater : std::strong_ordering::less;
  return std::lexicographical_compare_three_way(left.pre_release_.begin(), left.pre_release_.end(),
                                                right.pre_release_.begin(), right.pre_release_.end(),
                                                compare);
}

}  // namespace adit::update
