#pragma once

#include <optional>
#include <string>
#include <vector>

#include "alarms/arrival.hpp"
#include "alarms/facts.hpp"

namespace adit::alarms {

/// A stream's state on all faces.
struct Standing {
  Arrival arrival = Arrival::NotYet;
  Level level = Level::Quiet;
};

/// `stream` must be one of `facts`. Only the largest cause is blamed, as in the list of conditions. While the
/// mapping endpoint is stopped, queued data is NotArriving at level Quiet, and no robot is silent. While the
/// team's cable is out, no robot is silent. After the endpoint recovers, queued data is Late until each
/// sender has had its turn.
Standing standing_of(const Stream& stream, const Facts& facts);

/// Whether the robot has stopped sending by its own fault.
bool is_silent(const std::string& robot, const Facts& facts);

/// Names of the silent robots that have sent no message since the service started.
std::vector<std::string> unheard(const Facts& facts);

/// The mapping endpoint if it accepts no messages at all, or null.
const Endpoint* stopped(const Facts& facts);

/// Seconds that the oldest message has been queued while the endpoint accepted messages, at most.
/// std::nullopt: the queue is empty.
std::optional<double> waited(const Stream& stream, const Facts& facts);

/// Answers "is my map arriving?" for all robots.
struct Verdict {
  Level level = Level::Quiet;
  std::string what = {}, why = {};
  static const codec::Row kRow;
  friend bool operator==(const Verdict&, const Verdict&) = default;
};

Verdict verdict_of(const Facts& facts);

}  // namespace adit::alarms
