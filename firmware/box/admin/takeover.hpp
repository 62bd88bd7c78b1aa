#pragma once

#include <expected>
#include <string>

#include "admin/store.hpp"
#include "dispatch/merged_reports.hpp"
#include "ledger/ledger.hpp"
#include "loop/loop.hpp"
#include "settings/settings.hpp"
#include "spare/content.hpp"

namespace adit::admin {

/// Takeover from another box's export, safe against a power cut. begin() stores the export; the next finish()
/// executes it, and a later finish() completes an interrupted one.
class Takeover {
 public:
  /// The export, with the other box's tokens; removed at the end.
  static constexpr const char* kFile = "take-over";

  /// `store` must outlive this object.
  Takeover(Store& store, std::string state_folder) : store_(store), state_(std::move(state_folder)) {}

  /// The export's settings. Error: the takeover is impossible. Does not change the box.
  std::expected<settings::Saved, std::string> check(const spare::Content& content) const;
  /// `content`: from spare::write(). Error: the takeover has not begun.
  std::expected<void, std::string> begin(const std::string& content);
  /// If begun, takes over reports and runs into the ledger, settings, tokens and the stamp floor. Then
  /// returns true. Call before other objects use these. Error: unfinished; the box must be a standby until it
  /// is finished.
  std::expected<bool, std::string> finish(const loop::Loop& loop);
  /// Why finish() does not know whether a takeover has begun, or "".
  const std::string& unread() const { return unread_; }
  /// Abandons an unfinished takeover. Finished steps stay.
  std::expected<void, std::string> abandon();

 private:
  std::string begun() const { return state_ + '/' + kFile; }
  std::expected<void, std::string> take(const spare::Content& content, const loop::Loop& loop);
  std::expected<void, std::string> take_ledger(const spare::Content& content,
                                               const dispatch::Handover& handover,
                                               const ledger::Known& known);
  std::expected<void, std::string> take_settings(const spare::Content& content);
  std::expected<void, std::string> note(const spare::About& about);

  Store& store_;
  std::string state_, unread_;
};

}  // namespace adit::admin
