#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace adit::icd {

/// A bearer token (ICD 4, RFC 6750). reveal() is the only access to it; its caller must not print the text.
class BearerToken {
 public:
  static constexpr std::size_t kLongest = 256;

  /// nullopt unless `text` is 1 to 256 visible ASCII characters (0x21 to 0x7e).
  static std::optional<BearerToken> parse(std::string_view text);

  /// The token that is a file's content, without the white space around it. ASCII, UTF-8 with a byte order
  /// mark, or UTF-16 with one, as editors and shells of Windows write it.
  static std::optional<BearerToken> parse_file(std::string_view content);

  /// The token's characters, for the Authorization header only.
  const std::string& reveal() const { return text_; }

  /// Takes the same time wherever the two differ.
  bool matches(std::string_view presented) const;

  /// Replaces the token by "[token]" in a text from another program that others will read: a field of a
  /// client, or a server's echo. Also finds the token as JSON, CSV and HTML write it, and its beginning if
  /// quote_text() has cut it. A token of less than 4 characters is no secret and stays.
  void strike_from(std::string& text) const;
  /// False if strike_from() cannot find anything in `text`. Faster than strike_from().
  bool can_be_in(std::string_view text) const;

 private:
  explicit BearerToken(std::string text);
  std::string text_;
  std::size_t sought_;  // characters before the first one that JSON, CSV or HTML escapes, at most 8
};

/// True if both are the same token, or both are absent.
bool same(const std::optional<BearerToken>& one, const std::optional<BearerToken>& other);

/// The time does not depend on which token matches.
bool is_one_of(std::span<const BearerToken> tokens, std::string_view presented);

/// The token of an Authorization header: `Bearer <token>`, the scheme in any case (RFC 9110 11.1); or "".
std::string_view token_in(std::string_view authorization);

/// Replaces the box's secrets in texts that others read. A secret may be anywhere, for example in a marker's
/// text, a robot's name or a sentence of the Command Post.
class Redaction {
 public:
  /// A secret shorter than this stays in strings and in HTML, because it may be a word that a page needs.
  static constexpr std::size_t kShortest = 8;

  explicit Redaction(std::vector<BearerToken> secrets = {}) : secrets_(std::move(secrets)) {}

  void add(BearerToken secret) { secrets_.push_back(std::move(secret)); }

  /// For plain text or CSV: replaces secrets anywhere.
  void strike_from(std::string& text) const;
  /// For JSON, a stream of it, or Prometheus' text format: replaces secrets in strings that are values.
  void strike_from_strings(std::string& text) const;
  /// For HTML whose text was written by escape_html().
  void strike_from_html(std::string& text) const { strike_long_from(text); }

 private:
  bool can_be_in(std::string_view text) const;
  void strike_long_from(std::string& text) const;

  std::vector<BearerToken> secrets_;
};

}  // namespace adit::icd
