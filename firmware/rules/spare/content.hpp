#pragma once

#include <cstdint>
#include <expected>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "codec/row.hpp"
#include "icd/bearer_token.hpp"
#include "icd/scoring.hpp"

namespace adit::spare {

/// The box that made an export, and its state at the standby.
struct ExportInfo {
  std::string box = "";      // number that the box drew once, in hexadecimal digits
  std::string name = "";     // its address and port for the team
  std::string version = "";  // of Adit
  double at = 0;             // start of the standby; seconds since 1970
  double stamp = 0;          // stamp clock at `at`; seconds since 1970
  /// Number of standbys, including this one. std::nullopt: from an earlier Adit.
  std::optional<std::int64_t> rest_count = std::nullopt;
  std::optional<double> told_at = std::nullopt;      // `at`, if the time of day was reliable
  double stamps = 0;                                 // bound of all stamps that it used
  std::int64_t reports = 0, open = 0;                // all reports, and those not finished
  std::string post = "";                             // the Command Post's address and port
  std::optional<icd::RunStatus> run = std::nullopt;  // last status
  /// The answer of /api/status at the standby. std::nullopt: not known for certain.
  std::optional<icd::RunStatus> expected = std::nullopt;
  static const codec::Row kRow;
};

/// Data that a box hands to its spare.
struct Content {
  ExportInfo about;
  std::string settings;                            // the settings file
  std::map<std::string, icd::BearerToken> tokens;  // by name
  std::string ledger;                              // Ledger::copy()
  std::string certificate = {};                    // access::KeyAndChain::text(), or ""
};

/// The text to seal: parts, each as "NAME SIZE", a newline, and SIZE bytes.
std::string write(const Content& content);
/// Each part must occur once; tokens and certificate are optional; others are errors. An error is a sentence.
std::expected<Content, std::string> read(std::string_view text);

}  // namespace adit::spare
