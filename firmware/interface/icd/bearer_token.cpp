#include "icd/bearer_token.hpp"

#include <algorithm>
#include <cstring>

#include "icd/sentence.hpp"
#include "icd/text.hpp"

namespace adit::icd {
namespace {

constexpr std::string_view kStruck = "[token]";
constexpr std::size_t kShortest = 4;
constexpr std::size_t kLeast = 8;  // minimum length of a beginning that is replaced

void strike_token(std::string& text, std::string_view token) {
  for (std::size_t at = 0; (at = text.find(token, at)) != std::string::npos; at += kStruck.size()) {
    text.replace(at, token.size(), kStruck);
  }
}

/// Puts `mark` before each of `letters`.
std::string insert_before_letters(std::string_view token, std::string_view letters, char mark) {
  std::string text;
  for (const char letter : token) {
    if (letters.contains(letter)) text += mark;
    text += letter;
  }
  return text;
}

/// ASCII in UTF-16 as bytes; others become bytes that no token has. `high`: place of the high byte in a pair.
std::string decode_utf_16(std::string_view pairs, std::size_t high) {
  std::string text;
  for (; pairs.size() >= 2; pairs.remove_prefix(2)) text += pairs[high] == '\0' ? pairs[1 - high] : '\0';
  return pairs.empty() ? text : text + '\0';
}

/// quote_text() shows the beginning of a long text, followed by "...".
void strike_cut(std::string& text, std::string_view token) {
  const std::string_view beginning = token.substr(0, kLeast);
  for (std::size_t at = 0; (at = text.find(beginning, at)) != std::string::npos; ++at) {
    const auto differs = std::ranges::mismatch(std::string_view(text).substr(at), token).in1;
    const auto size = static_cast<std::size_t>(differs - std::string_view(text).substr(at).begin());
    if (std::string_view(text).substr(at + size).starts_with("...")) text.replace(at, size, kStruck);
  }
}

}  // namespace

BearerToken::BearerToken(std::string text)
    : text_(std::move(text)), sought_(std::min({text_.find_first_of("\"\\&<>'"), text_.size(), kLeast})) {}

std::optional<BearerToken> BearerToken::parse(std::string_view text) {
  const auto visible = [](char letter) { return letter > 0x20 && letter < 0x7f; };
  if (text.empty() || text.size() > kLongest || !std::ranges::all_of(text, visible)) return std::nullopt;
  return BearerToken(std::string(text));
}

std::optional<BearerToken> BearerToken::parse_file(std::string_view content) {
  constexpr std::string_view kUtf8 = "\xEF\xBB\xBF", kLittleEndian = "\xFF\xFE", kBigEndian = "\xFE\xFF";
  if (content.starts_with(kLittleEndian)) return parse(trim(decode_utf_16(content.substr(2), 1)));
  if (content.starts_with(kBigEndian)) return parse(trim(decode_utf_16(content.substr(2), 0)));
  if (content.starts_with(kUtf8)) content.remove_prefix(kUtf8.size());
  return parse(trim(content));
}

bool BearerToken::matches(std::string_view presented) const {
  unsigned difference = presented.size() == text_.size() ? 0 : 1;
  for (std::size_t i = 0; i < text_.size(); ++i) {
    const char other = presented.empty() ? '\0' : presented[i % presented.size()];
    difference |= static_cast<unsigned char>(text_[i]) ^ static_cast<unsigned char>(other);
  }
  return difference == 0;
}

bool BearerToken::can_be_in(std::string_view text) const {
  // memmem() is fast enough for megabytes.
  return ::memmem(text.data(), text.size(), text_.data(), sought_) != nullptr;
}

void BearerToken::strike_from(std::string& text) const {
  if (text_.size() < kShortest || !can_be_in(text)) return;
  strike_token(text, text_);
  if (text_.find_first_of("\"\\") != std::string::npos) {
    const std::string in_json = insert_before_letters(text_, "\"\\", '\\');
    strike_token(text, insert_before_letters(in_json, "\"\\", '\\'));  // a stored answer within JSON
    strike_token(text, in_json);
    strike_token(text, insert_before_letters(text_, "\"", '"'));  // CSV
  }
  if (text_.find_first_of("\"&<>'") != std::string::npos) strike_token(text, escape_html(text_));
  strike_cut(text, text_);
}

bool same(const std::optional<BearerToken>& one, const std::optional<BearerToken>& other) {
  return one && other ? one->matches(other->reveal()) : one.has_value() == other.has_value();
}

bool is_one_of(std::span<const BearerToken> tokens, std::string_view presented) {
  bool found = false;
  for (const BearerToken& token : tokens) {
    if (token.matches(presented)) found = true;  // no early exit: the time must not reveal which one matches
  }
  return found;
}

std::string_view token_in(std::string_view authorization) {
  constexpr std::string_view kBlanks = " \t";
  constexpr std::string_view kScheme = "bearer";
  authorization = trim(authorization, kBlanks);
  if (authorization.size() <= kScheme.size() ||
      !equals_ignoring_case(authorization.substr(0, kScheme.size()), kScheme))
    return {};
  authorization.remove_prefix(kScheme.size());
  if (kBlanks.find(authorization.front()) == std::string_view::npos) return {};
  authorization.remove_prefix(authorization.find_first_not_of(kBlanks));
  return authorization;
}

namespace {

/// The index after the string's closing quotation mark. Its opening one is at `at`.
std::size_t end_of_string(std::string_view text, std::size_t at) {
  for (++at; at < text.size() && text[at] != '"'; ++at) {
    if (text[at] == '\\') ++at;
  }
  return std::min(at + 1, text.size());
}

}  // namespace

void Redaction::strike_from(std::string& text) const {
  for (const BearerToken& secret : secrets_) secret.strike_from(text);
}

bool Redaction::can_be_in(std::string_view text) const {
  return std::ranges::any_of(secrets_, [text](const BearerToken& secret) {
    return secret.reveal().size() >= kShortest && secret.can_be_in(text);
  });
}

void Redaction::strike_from_strings(std::string& text) const {
  if (!can_be_in(text)) return;
  std::string struck;
  std::size_t done = 0;
  for (std::size_t at = 0; (at = text.find('"', at)) != std::string::npos;) {
    const std::size_t end = end_of_string(text, at);
    const bool is_name = end < text.size() && text[end] == ':';
    if (!is_name) {
      std::string value = text.substr(at, end - at);
      strike_long_from(value);
      struck.append(text, done, at - done).append(value);
      done = end;
    }
    at = end;
  }
  text = struck.append(text, done);
}

void Redaction::strike_long_from(std::string& text) const {
  for (const BearerToken& secret : secrets_) {
    if (secret.reveal().size() >= kShortest) secret.strike_from(text);
  }
}

}  // namespace adit::icd
