#include "codec/json_string.hpp"

#include "codec/byte_name.hpp"
#include "codec/json_characters.hpp"
#include "icd/require.hpp"
#include "icd/text.hpp"

namespace adit::codec {
namespace {

bool is_hex(char c) {
  return is_digit(c) || (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F');
}

/// Requires four hex digits.
char32_t unit(std::string_view digits) {
  const auto value = icd::number_in<unsigned>(digits, 16);
  icd::require(digits.size() == 4 && value);
  return *value;
}

constexpr const char* kLone = "a surrogate without its partner in a string";

}  // namespace

std::expected<JsonString::Piece, Fault> JsonString::next(std::string_view in) {
  icd::require(!in.empty());
  if (!escape_.empty()) return escape(in);
  auto run = plain(in);
  if (!run || run->taken > 0) return run;
  if (in[0] == '\\') return escape(in);
  return std::unexpected(Fault{0, "a raw control character in a string (" + byte_name(in[0]) + ")"});
}

std::expected<JsonString::Piece, Fault> JsonString::plain(std::string_view in) {
  std::size_t n = 0;
  while (n < in.size()) {
    if (utf8_.complete()) {
      while (n < in.size() && is_plain(in[n])) ++n;
      if (n == in.size() || static_cast<unsigned char>(in[n]) < 0x80) break;
    }
    if (!utf8_.next(static_cast<std::uint8_t>(in[n]))) {
      if (n > 0) break;  // returns the good part first
      return std::unexpected(Fault{n, "a string that is not UTF-8 (" + byte_name(in[n]) + ")"});
    }
    ++n;
  }
  const std::string_view run = in.substr(0, n);
  const bool ended = utf8_.complete() && n < in.size() && in[n] == '"';
  return Piece{.taken = ended ? n + 1 : n, .raw = run, .text = run, .ended = ended};
}

std::expected<JsonString::Piece, Fault> JsonString::escape(std::string_view in) {
  for (std::size_t n = 0; n < in.size(); ++n) {
    const auto ends = escape_ends_with(in[n]);
    if (!ends) return std::unexpected(Fault{n, ends.error()});
    if (!*ends) continue;
    finished_.swap(escape_);
    escape_.clear();
    return Piece{.taken = n + 1, .raw = finished_, .text = meaning_};
  }
  return Piece{.taken = in.size(), .raw = {}, .text = {}};
}

std::expected<bool, const char*> JsonString::escape_ends_with(char c) {
  const std::size_t place = escape_.size();
  escape_.push_back(c);
  if (place == 0) return false;  // the backslash
  if (place == 1) {
    constexpr std::string_view kShort = "\"\\/bfnrt";
    constexpr std::string_view kShortMeans = "\"\\/\b\f\n\r\t";
    if (c == 'u') return false;
    const std::size_t which = kShort.find(c);
    if (which == std::string_view::npos) return std::unexpected("an escape that JSON does not have");
    meaning_ = kShortMeans[which];
    return true;
  }
  if (place == 6) return c == '\\' ? std::expected<bool, const char*>(false) : std::unexpected(kLone);
  if (place == 7) return c == 'u' ? std::expected<bool, const char*>(false) : std::unexpected(kLone);
  if (!is_hex(c)) return std::unexpected("an escape \\u without four hex digits");
  return place == 5 || place == 11 ? unicode_escape_ends() : false;
}

std::expected<bool, const char*> JsonString::unicode_escape_ends() {
  const char32_t first = unit(std::string_view(escape_).substr(2, 4));
  meaning_.clear();
  if (escape_.size() == 6) {
    if (first >= 0xD800 && first <= 0xDBFF) return false;  // the other half must follow
    if (first >= 0xDC00 && first <= 0xDFFF) return std::unexpected(kLone);
    append_utf8(meaning_, first);
    return true;
  }
  const char32_t second = unit(std::string_view(escape_).substr(8, 4));
  if (second < 0xDC00 || second > 0xDFFF) return std::unexpected(kLone);
  append_utf8(meaning_, 0x10000 + ((first - 0xD800) << 10) + (second - 0xDC00));
  return true;
}

}  // namespace adit::codec
