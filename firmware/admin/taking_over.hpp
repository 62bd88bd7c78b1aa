#pragma once

#include <expected>
#include <string>
#include <vector>

#include "admin/store.hpp"
#include "dispatch/taking_over.hpp"
#include "ledger/ledger.hpp"
#include "loop/loop.hpp"
#include "spare/content.hpp"

namespace adit::admin {

/// The box goes on where another one came to rest, also where the power goes in the midst of it: once
/// begin() has written the export down, it is done by the next finish(), and what that leaves undone by the
/// one after it.
class TakingOver {
 public:
  /// What is being taken over, with the other team's tokens: nothing of it stays.
  static constexpr const char* kFile = "take-over";

  /// `store` outlives this.
  TakingOver(Store& store, std::string state_folder) : store_(store), state_(std::move(state_folder)) {}

  /// The paths of those of its settings that this box does not know, and will leave out. An error: why it
  /// cannot take over from that one. Nothing is changed.
  std::expected<std::vector<std::string>, std::string> check(const spare::Content& content) const;
  /// `content`: spare::write(). An error: nothing is begun.
  std::expected<void, std::string> begin(const std::string& content);
  /// Takes over reports and runs into the ledger, settings, tokens and the bound of stamps, where that was
  /// begun: then true. Called while nothing else uses them. An error says why it is not finished: until it
  /// is, the box must rest.
  std::expected<bool, std::string> finish(const loop::Loop& loop);
  /// Why finish() could not read whether there is one to finish, or "".
  const std::string& unread() const { return unread_; }
  /// What cannot be finished is forgotten; what of it is done stays.
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
