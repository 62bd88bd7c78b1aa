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

/// The standby of the box.
struct Rest {
  std::string code = "";                       // of its export
  double since = 0;                            // seconds since 1970
  std::optional<double> stamp = std::nullopt;  // then; nothing: an earlier Adit did not note it
  std::optional<double> told = std::nullopt;   // spare::About::told_at
  /// What /api/status would have answered once nothing was under way any more; nothing: not known for
  /// certain.
  std::optional<icd::RunStatus> expected = std::nullopt;
  static const codec::Row kRow;
};

/// An export that was taken over from.
struct TakenFrom {
  std::string box = "";
  double at = 0;                                          // when that box came to rest
  std::optional<std::int64_t> rest_count = std::nullopt;  // spare::About
  static const codec::Row kRow;
};

/// What a box keeps of itself and its spare, in the state folder: it must outlive everything.
struct SpareFile {
  std::string box = "";  // its own number; "": it drew none yet
  std::optional<Rest> rest = std::nullopt;
  std::optional<std::int64_t> rest_count = std::nullopt;  // spare::About
  std::vector<TakenFrom> taken = {};

  static const codec::Row kRow;
  static constexpr const char* kName = "spare.json";
  /// One that is not there yet is new.
  static std::expected<SpareFile, std::string> read(const std::string& state_folder);
  /// `unread`: the error if it cannot be read. Then it must not be replaced; one that is damaged may be.
  static std::expected<SpareFile, std::string> read(const std::string& state_folder, std::string& unread);
  std::expected<void, std::string> write(const std::string& state_folder) const;

  /// Why that export must not be taken over from; "": it may.
  std::string hindrance(const spare::About& about) const;
};

}  // namespace adit::admin
