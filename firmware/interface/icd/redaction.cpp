#include "icd/redaction.hpp"

#include <algorithm>

namespace adit::icd {
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

bool Redaction::may_be_in(std::string_view text) const {
  return std::ranges::any_of(secrets_, [text](const BearerToken& secret) {
    return secret.reveal().size() >= kShortest && secret.may_be_in(text);
  });
}

void Redaction::strike_from_strings(std::string& text) const {
  if (!may_be_in(text)) return;
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

void Redaction::strike_from_html(std::string& text) const {
  strike_long_from(text);
}

void Redaction::strike_long_from(std::string& text) const {
  for (const BearerToken& secret : secrets_) {
    if (secret.reveal().size() >= kShortest) secret.strike_from(text);
  }
}

}  // namespace adit::icd
