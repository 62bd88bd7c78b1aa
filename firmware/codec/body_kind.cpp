// What the headers say of a body.
#include <algorithm>

#include "codec/body_decoder.hpp"

namespace adit::codec {
namespace {

constexpr std::string_view kBlanks = " \t";  // RFC 9110 5.6.3

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

/// `name` is in small letters.
bool is(std::string_view text, std::string_view name) {
  return std::ranges::equal(text, name, [](char a, char b) { return lower(a) == b; });
}

}  // namespace

std::optional<Format> format_of(std::string_view content_type) {
  const std::string_view type = trimmed(content_type.substr(0, content_type.find(';')));
  if (is(type, "application/json")) return Format::Json;
  if (is(type, "application/cbor")) return Format::Cbor;
  return std::nullopt;
}

std::optional<ContentCoding> coding_of(std::string_view content_encoding) {
  const std::string_view coding = trimmed(content_encoding);
  if (coding.empty() || is(coding, "identity")) return ContentCoding::Identity;
  if (is(coding, "gzip") || is(coding, "x-gzip")) return ContentCoding::Gzip;
  if (is(coding, "deflate")) return ContentCoding::Deflate;
  return std::nullopt;
}

}  // namespace adit::codec
