#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "icd/bearer_token.hpp"

namespace adit::icd {

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
  /// For HTML whose text was written by in_html().
  void strike_from_html(std::string& text) const;

 private:
  bool may_be_in(std::string_view text) const;
  void strike_long_from(std::string& text) const;

  std::vector<BearerToken> secrets_;
};

}  // namespace adit::icd
