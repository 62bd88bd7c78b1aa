#pragma once

#include <expected>
#include <string>

#include "admin/store.hpp"

namespace adit::admin {

/// Back to the first start, also where the power goes in the midst of it: once begin() has written it down,
/// it is done by the next finish(), and what that leaves undone by the one after it. Reports are kept.
class FactoryReset {
 public:
  /// In the state folder, while a reset is under way.
  static constexpr const char* kFile = "reset";

  /// `store` outlives this.
  FactoryReset(Store& store, std::string state_folder, std::string runtime_folder);

  /// An error: nothing is forgotten.
  std::expected<void, std::string> begin();
  /// Forgets settings, tokens, passwords, the code, who is logged in, what waits or is set aside and, by
  /// adit-network, the box's addresses, where that was begun: then true. Called while nothing else uses them.
  /// An error says what is left, or why it is not known whether it was begun: then nothing is forgotten.
  std::expected<bool, std::string> finish();
  /// Why finish() does not know whether it was begun, or "": until that is known, the box must be on standby.
  const std::string& unread() const { return unread_; }

 private:
  std::string begun() const { return state_ + '/' + kFile; }

  Store& store_;
  std::string state_, runtime_, unread_;
};

}  // namespace adit::admin
