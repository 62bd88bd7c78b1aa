#pragma once

#include <expected>
#include <functional>
#include <string>

#include "applier/update_options.hpp"
#include "update/bundle.hpp"

namespace adit::applier {

/// RAUC, as a program. What it says of a bundle is after its signature was found good. Errors are sentences.
class Rauc {
 public:
  explicit Rauc(std::string command) : command_(std::move(command)) {}

  /// Which board and slot this is; not the version. Waits while RAUC is at work, for it says nothing
  /// meanwhile.
  std::expected<update::Running, std::string> status() const;
  std::expected<update::Bundle, std::string> info(const std::string& bundle) const;
  /// Writes the slot that does not run, and has it started next. `progress`: per cent, as it goes. After an
  /// error RAUC may be at work still.
  std::expected<void, std::string> install(const std::string& bundle,
                                           const std::function<void(int)>& progress) const;
  /// The slot that runs came up healthy: its starts are counted from none again.
  std::expected<void, std::string> mark_good() const;
  /// The other slot is to be started next, with all its tries: what it holds was good once.
  std::expected<void, std::string> start_other_next() const;
  /// The slot that runs is to be started next.
  std::expected<void, std::string> start_booted_next() const;
  /// And the other one never, until it is written again.
  std::expected<void, std::string> leave_other() const;

 private:
  std::string command_;
};

}  // namespace adit::applier
