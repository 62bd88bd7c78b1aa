#pragma once

#include <expected>
#include <functional>
#include <string>

#include "applier/options.hpp"
#include "update/bundle.hpp"

namespace adit::applier {

/// VERSION_ID of os-release(5) without quotation marks; "" if absent.
std::string version_in(const std::string& path);

/// RAUC as a program. It describes a bundle only after its signature was verified. Errors are sentences.
class Rauc {
 public:
  explicit Rauc(std::string command) : command_(std::move(command)) {}

  /// The board and the running slot, without the version. Blocks while RAUC is busy, because it gives no
  /// status then.
  std::expected<update::Running, std::string> status() const;
  std::expected<update::Bundle, std::string> info(const std::string& bundle) const;
  /// Writes the other slot and makes it the next to start. `progress`: per cent. After an error RAUC may
  /// still be at work.
  std::expected<void, std::string> install(const std::string& bundle,
                                           const std::function<void(int)>& progress) const;
  /// Marks the running slot healthy and resets its count of starts.
  std::expected<void, std::string> mark_good() const;
  /// Starts the other slot next, with all tries. Its content must have been good once.
  std::expected<void, std::string> start_other_next() const;
  /// Starts the running slot next.
  std::expected<void, std::string> start_booted_next() const;
  /// Starts the running slot next, and the other one not before it is written again.
  std::expected<void, std::string> leave_other() const;

 private:
  std::string command_;
};

}  // namespace adit::applier
