#pragma once

#include <cstdint>
#include <expected>
#include <optional>
#include <string>
#include <vector>

#include "admin/store.hpp"
#include "codec/row.hpp"
#include "dispatch/merged_reports.hpp"
#include "icd/scoring.hpp"
#include "ledger/ledger.hpp"
#include "loop/loop.hpp"
#include "settings/settings.hpp"
#include "spare/content.hpp"

namespace adit::admin {

/// A standby of the box.
struct Standby {
  std::string code = "";                       // of the export
  double since = 0;                            // seconds since 1970
  std::optional<double> stamp = std::nullopt;  // at `since`; nullopt: from an earlier Adit
  std::optional<double> told = std::nullopt;   // spare::ExportInfo::told_at
  /// The answer of /api/status after the last request in flight. std::nullopt: not known for certain.
  std::optional<icd::RunStatus> expected = std::nullopt;
  static const codec::Row kRow;
};

/// An export that was taken over from.
struct TakeoverRecord {
  std::string box = "";
  double at = 0;                                          // start of that box's standby
  std::optional<std::int64_t> rest_count = std::nullopt;  // spare::ExportInfo
  static const codec::Row kRow;
};

/// The box's permanent record of itself and its spare, in the state directory.
struct SpareFile {
  std::string box = "";  // the box's own number; "": not drawn yet
  std::optional<Standby> rest = std::nullopt;
  std::optional<std::int64_t> rest_count = std::nullopt;  // spare::ExportInfo
  std::vector<TakeoverRecord> taken = {};

  static const codec::Row kRow;
  static constexpr const char* kName = "spare.json";
  /// A missing file reads as a new record.
  static std::expected<SpareFile, std::string> read(const std::string& state_folder);
  /// `unread`: the error if the file cannot be read. Such a file must not be replaced; a damaged one may be.
  static std::expected<SpareFile, std::string> read(const std::string& state_folder, std::string& unread);
  std::expected<void, std::string> write(const std::string& state_folder) const;

  /// Why this export must not be taken over from, or "".
  std::string refusal_reason(const spare::ExportInfo& about) const;
};

/// Takeover from another box's export, safe against a power cut. begin() stores the export; the next finish()
/// executes it, and a later finish() completes an interrupted one.
class Takeover {
 public:
  /// The export, with the other box's tokens; removed at the end.
  static constexpr const char* kFile = "take-over";

  /// `store` must outlive this object. `memory`: the ledger's file in memory (Ledger::open()).
  Takeover(Store& store, std::string state_folder, std::string memory)
      : store_(store), state_(std::move(state_folder)), memory_(std::move(memory)) {}

  /// The export's settings. Error: the takeover is impossible. Does not change the box.
  std::expected<settings::SavedSettings, std::string> check(const spare::Content& content) const;
  /// `content`: from spare::write(). Error: the takeover has not begun.
  std::expected<void, std::string> begin(const std::string& content);
  /// If begun, takes over reports and runs into the ledger, settings, tokens, certificate and stamp floor,
  /// and returns true. Call before others use these. Error: unfinished; the box must be a standby until then.
  std::expected<bool, std::string> finish(const loop::Loop& loop);
  /// Why finish() does not know whether a takeover has begun, or "".
  const std::string& unread() const { return unread_; }
  /// Abandons an unfinished takeover. Finished steps stay.
  std::expected<void, std::string> abandon();

 private:
  std::string marker_path() const { return state_ + '/' + kFile; }
  std::expected<void, std::string> apply(const spare::Content& content, const loop::Loop& loop);
  std::expected<void, std::string> apply_ledger(const spare::Content& content,
                                                const dispatch::Handover& handover,
                                                const ledger::LedgerFacts& known);
  std::expected<void, std::string> apply_settings(const spare::Content& content);
  std::expected<void, std::string> note(const spare::ExportInfo& about);

  Store& store_;
  std::string state_, memory_, unread_;
};

}  // namespace adit::admin
