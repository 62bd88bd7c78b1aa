#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "icd/header.hpp"

namespace adit::queues {

/// Identifies a client's connection within this process; 0: unknown.
using Connection = std::uint64_t;

/// Distinguishes a clock that was set back from messages that overtook each other.
///
/// Messages on one connection arrive in sending order. Messages on several connections may overtake each
/// other, but a client waits for each answer: only one of two connections can be behind, by one message. So
/// if a message is older than the previous one by more than kOutOfOrder, the clock was set back if
/// - its own connection has already had a later stamp, or
/// - the previous message was late as well, and this one has a later stamp than that.
/// Smaller steps are ignored: poses are not so frequent that they matter.
class StepBack {
 public:
  static constexpr double kOutOfOrder = 1.0;           // seconds
  static constexpr std::size_t kMostConnections = 16;  // the connections that are distinguished

  /// Whether a message with this stamp, on the sender's clock, shows that the clock was set back. If so,
  /// earlier stamps are forgotten.
  bool shown_by(icd::Stamp stamp, Connection connection);

 private:
  struct Heard {
    Connection connection = 0;
    icd::Stamp last = 0;
  };
  bool shows(icd::Stamp stamp, const Heard* on_it) const;
  bool is_late(icd::Stamp stamp, icd::Stamp than) const { return stamp < than - kOutOfOrder; }

  std::vector<Heard> heard_;  // the most recent one is last
  std::optional<icd::Stamp> latest_;
  std::optional<icd::Stamp> late_;  // the previous message's stamp, if that message was late
};

}  // namespace adit::queues
