#pragma once

#include <expected>
#include <string>

#include "admin/store.hpp"

namespace adit::admin {

/// Back to the first start, also where the power goes in the midst of it: once begin() has written it down,
/// it is done by the next finish(), and what that leaves undone by the one after it. Reports are kept.
class FactoryReset {
 public:
  /// `store` outlives this.
  FactoryReset(Store& store, std::string state_folder, std::string runtime_folder);

  /// An error: nothing is forgotten.
  std::expected<void, std::string> begin();
  /// Forgets settings, tokens, passwords, the code, who is logged in, what waits or is set aside and, by
  /// adit-network, the box's addresses, where that was begun: then true. Called while nothing else uses them.
  /// An error says what is left, or why it is not known whether it was begun: then nothing is forgotten.
  std::expected<bool, std::string> finish();

 private:
  std::string begun() const { return state_ + "/reset"; }

  Store& store_;
  std::string state_, runtime_;
};

}  // namespace adit::admin
