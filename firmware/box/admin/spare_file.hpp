#pragma once

#include <cstdint>
#include <expected>
#include <optional>
#include <string>
#include <vector>

#include "codec/row.hpp"
#include "icd/run_status.hpp"
#include "spare/content.hpp"

namespace adit::admin {

/// A standby of the box.
struct Rest {
  std::string code = "";                       // of the export
  double since = 0;                            // seconds since 1970
  std::optional<double> stamp = std::nullopt;  // at `since`; nullopt: from an earlier Adit
  std::optional<double> told = std::nullopt;   // spare::About::told_at
  /// The answer of /api/status after the last request in flight. std::nullopt: not known for certain.
  std::optional<icd::RunStatus> expected = std::nullopt;
  static const codec::Row kRow;
};

/// An export that was taken over from.
struct TakenFrom {
  std::string box = "";
  double at = 0;                                          // start of that box's standby
  std::optional<std::int64_t> rest_count = std::nullopt;  // spare::About
  static const codec::Row kRow;
};

/// The box's permanent record of itself and its spare, in the state directory.
struct SpareFile {
  std::string box = "";  // the box's own number; "": not drawn yet
  std::optional<Rest> rest = std::nullopt;
  std::optional<std::int64_t> rest_count = std::nullopt;  // spare::About
  std::vector<TakenFrom> taken = {};

  static const codec::Row kRow;
  static constexpr const char* kName = "spare.json";
  /// A missing file reads as a new record.
  static std::expected<SpareFile, std::string> read(const std::string& state_folder);
  /// `unread`: the error if the file cannot be read. Such a file must not be replaced; a damaged one may be.
  static std::expected<SpareFile, std::string> read(const std::string& state_folder, std::string& unread);
  std::expected<void, std::string> write(const std::string& state_folder) const;

  /// Why this export must not be taken over from, or "".
  std::string hindrance(const spare::About& about) const;
};

}  // namespace adit::admin
