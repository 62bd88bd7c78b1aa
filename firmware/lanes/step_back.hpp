#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "icd/header.hpp"

namespace adit::lanes {

/// Names a connection that messages come on, for as long as the process lives; 0: not known, or of no
/// meaning.
using Connection = std::uint64_t;

/// Tells a clock that was set back from messages that overtook each other on their way.
///
/// On one connection, messages come in the order in which they were sent. On several connections they may
/// overtake each other, but a client waits for each answer: of two connections only one can be behind, by one
/// message, and its next message is news. So if a message is older than the one before by more than
/// kOutOfOrder, its clock was set back if
/// - its own connection has already brought a later stamp, or
/// - the message before it was late too, and this one was stamped after that.
/// A message that is late by less is not taken for one: robots do not send poses so often that it would
/// matter.
class StepBack {
 public:
  static constexpr double kOutOfOrder = 1.0;           // seconds
  static constexpr std::size_t kMostConnections = 16;  // that are told apart

  /// Whether a message with this stamp, by the sender's own clock, shows that. If it does, all that was known
  /// of the clock before is forgotten.
  bool shown_by(icd::Stamp stamp, Connection connection);

 private:
  struct Heard {
    Connection connection = 0;
    icd::Stamp last = 0;
  };
  bool shows(icd::Stamp stamp, const Heard* on_it) const;
  bool is_late(icd::Stamp stamp, icd::Stamp than) const { return stamp < than - kOutOfOrder; }

  std::vector<Heard> heard_;  // the one heard last at the end
  std::optional<icd::Stamp> latest_;
  std::optional<icd::Stamp> late_;  // of the message before, where that was late
};

}  // namespace adit::lanes
