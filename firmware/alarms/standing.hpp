#pragma once

#include <optional>
#include <string>
#include <vector>

#include "alarms/arrival.hpp"
#include "alarms/facts.hpp"

namespace adit::alarms {

/// What all faces say of a stream: whether it arrives, and how well that is.
struct Standing {
  Arrival arrival = Arrival::NotYet;
  Level level = Level::Quiet;
};

/// `stream` is one of the facts'. A larger cause is blamed alone, as in the list of conditions: while the
/// mapping endpoint takes nothing, what waits does not arrive, at level Quiet, and no robot is silent; nor is
/// one while the team's cable is out. Once the endpoint takes again what it could not, what waited is late,
/// until each that sends has had its turn.
Standing standing_of(const Stream& stream, const Facts& facts);

/// It says nothing any more, and that is its own doing.
bool is_silent(const std::string& robot, const Facts& facts);

/// The silent robots without a stream, by name: they have sent no message since the service began.
std::vector<std::string> unheard(const Facts& facts);

/// The mapping endpoint, where nothing is taken at all; or null.
const Endpoint* stopped(const Facts& facts);

/// Seconds that the oldest news has waited at an endpoint that took it, at most; nothing: none waits.
std::optional<double> waited(const Stream& stream, const Facts& facts);

}  // namespace adit::alarms
