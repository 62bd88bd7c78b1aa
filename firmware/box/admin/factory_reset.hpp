#pragma once

#include <expected>
#include <string>

#include "admin/store.hpp"

namespace adit::admin {

/// Factory reset, safe against a power cut. begin() records the reset; the next finish() executes it, and a
/// later finish() completes an interrupted one. Reports are kept.
class FactoryReset {
 public:
  /// In the state directory, until the reset is finished.
  static constexpr const char* kFile = "reset";

  /// `store` must outlive this object.
  FactoryReset(Store& store, std::string state_folder, std::string runtime_folder);

  /// Error: the reset has not begun.
  std::expected<void, std::string> begin();
  /// If begun, deletes settings, tokens, the certificate, passwords, the code, sessions, stored runs, and
  /// queued and rejected messages, lets stamps step back that are far ahead (forward::StampFloor::forget()),
  /// requests factory addresses from adit-network, and returns true. Call before other objects use these.
  /// Error: the reset is incomplete, or (then all stays) it is unknown whether it has begun.
  std::expected<bool, std::string> finish();
  /// Why finish() does not know whether a reset has begun, or "". The box must then be a standby.
  const std::string& unread() const { return unread_; }

 private:
  std::string marker_path() const { return state_ + '/' + kFile; }

  Store& store_;
  std::string state_, runtime_, unread_;
};

}  // namespace adit::admin
