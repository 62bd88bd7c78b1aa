#pragma once

#include <optional>
#include <string>
#include <vector>

#include "alarms/alarm.hpp"
#include "facts/snapshot.hpp"

namespace adit::alarms {

/// A stream's state on all faces.
struct Standing {
  facts::Arrival arrival = facts::Arrival::NotYet;
  facts::Level level = facts::Level::Quiet;
};

/// `row` must be one of `traffic`. Only the largest cause is blamed, as in the list of conditions. While the
/// mapping endpoint is stopped, queued data is NotArriving at level Quiet. Then, and while the team's cable
/// is out, no robot is silent. After the endpoint recovers, queued data is Late until each sender's turn.
Standing standing_of(const facts::ActivityRow& row, const facts::Traffic& traffic);

/// Seconds that the oldest message was queued while the endpoint accepted, at most. std::nullopt: empty.
std::optional<double> queue_age(const facts::ActivityRow& row, const facts::Traffic& traffic);

/// Computes arrival, levels and words of the rows, the robots' ages, and the standings. `alarms`: the present
/// ones, which give a faulty endpoint its word.
void add_words(facts::Traffic& traffic, const std::vector<Alarm>& alarms);

/// Answers "is my map arriving?" for all robots.
struct Verdict {
  facts::Level level = facts::Level::Quiet;
  std::string what = {}, why = {};
  static const codec::Row kRow;
  friend bool operator==(const Verdict&, const Verdict&) = default;
};

/// Call after add_words().
Verdict verdict_of(const facts::Traffic& traffic);

}  // namespace adit::alarms
