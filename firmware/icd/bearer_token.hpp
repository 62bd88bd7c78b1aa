#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace adit::icd {

/// A bearer token (ICD 4, RFC 6750). It has no stream operator and no conversion: reveal() is the one way
/// out, and whoever calls it must not print what it gives.
class BearerToken {
 public:
  static constexpr std::size_t kLongest = 256;

  /// Nothing unless `text` is 1 to 256 visible ASCII characters (0x21 to 0x7e).
  static std::optional<BearerToken> parse(std::string_view text);

  /// The token's characters, for the Authorization header alone.
  const std::string& reveal() const { return text_; }

  /// Takes the same time wherever the two differ.
  bool matches(std::string_view presented) const;

  /// Replaces it by "[token]" wherever it stands in a text that somebody else wrote and others will read:
  /// what a client put into a wrong field, or a server echoed. So too as JSON, CSV and HTML write it, and its
  /// beginning where in_quotes() has cut it. A token of less than 4 characters is no secret, and stays.
  void strike_from(std::string& text) const;
  /// Whether anything of it could stand there to be struck: costs less.
  bool may_be_in(std::string_view text) const;

 private:
  explicit BearerToken(std::string text) : text_(std::move(text)) {}
  std::string text_;
};

/// Whether both are the same token, or none.
bool same(const std::optional<BearerToken>& one, const std::optional<BearerToken>& other);

/// Takes the same time whichever it is.
bool is_one_of(std::span<const BearerToken> tokens, std::string_view presented);

/// The token in an Authorization header's value: `Bearer <token>`, the scheme in any letter case (RFC
/// 9110 11.1). Empty where there is none.
std::string_view token_in(std::string_view authorization);

}  // namespace adit::icd
