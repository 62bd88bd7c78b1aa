#pragma once

#include <cstdint>
#include <expected>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "codec/row.hpp"
#include "icd/bearer_token.hpp"
#include "icd/run_status.hpp"

namespace adit::spare {

/// Which box made an export, and how all stood then.
struct About {
  std::string box = "";      // a number of the box's own, in hexadecimal digits, that it drew once
  std::string name = "";     // where the team found it: its address and port
  std::string version = "";  // of its Adit
  double at = 0;             // when it came to rest; seconds since 1970
  double stamp = 0;          // its clock for stamps then; seconds since 1970
  /// How often it came to rest, this time with them; nothing: an earlier Adit did not count.
  std::optional<std::int64_t> rest_count = std::nullopt;
  std::optional<double> told_at = std::nullopt;  // `at`, where somebody had set the time of day who knew it
  double stamps = 0;                             // no stamp that it gave out is later
  std::int64_t reports = 0, open = 0;            // all, and those with which something is still to happen
  std::string post = "";                         // the Command Post: address and port
  std::optional<icd::RunStatus> run = std::nullopt;  // as last heard
  /// What /api/status would have answered then; nothing: that was not known for certain.
  std::optional<icd::RunStatus> expected = std::nullopt;
  static const codec::Row kRow;
};

/// What a box hands on to its spare.
struct Content {
  About about;
  std::string settings;                            // the file
  std::map<std::string, icd::BearerToken> tokens;  // by name
  std::string ledger;                              // Ledger::copy()
};

/// As the text that is sealed: parts, each as "NAME SIZE", a line's end, and so many bytes.
std::string write(const Content& content);
/// Strict: each part is there once, and no other. An error is a sentence.
std::expected<Content, std::string> read(std::string_view text);

}  // namespace adit::spare
