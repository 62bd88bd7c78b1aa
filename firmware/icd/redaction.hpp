#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "icd/bearer_token.hpp"

namespace adit::icd {

/// Strikes the secrets that the box knows out of what others read, wherever somebody put one: a marker's
/// text, a robot's name, a sentence of the Command Post.
class Redaction {
 public:
  /// One of less than so many characters stays in strings and in HTML: it may be a word that a page needs.
  static constexpr std::size_t kShortest = 8;

  explicit Redaction(std::vector<BearerToken> secrets = {}) : secrets_(std::move(secrets)) {}

  void add(BearerToken secret) { secrets_.push_back(std::move(secret)); }

  /// Plain text or CSV: wherever they stand.
  void strike_from(std::string& text) const;
  /// JSON, a stream of it, or Prometheus' text format: within the strings that are values.
  void strike_from_strings(std::string& text) const;
  /// HTML, where in_html() wrote what is text.
  void strike_from_html(std::string& text) const;

 private:
  bool may_be_in(std::string_view text) const;
  void strike_long_from(std::string& text) const;

  std::vector<BearerToken> secrets_;
};

}  // namespace adit::icd
