#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "dispatch/report.hpp"

namespace adit::dispatch {

/// One of several message kinds on a connection.
struct Candidate {
  std::optional<Instant> oldest;  // when its oldest message was accepted; nullopt: no message
  Instant ready;                  // end of its rate limit or back-off
};

struct Turn {
  std::optional<std::size_t> candidate;  // its index
  std::optional<Instant> wake;           // without a candidate: when to ask again; nullopt: no messages
};

/// Chooses the oldest message among the candidates that are ready.
Turn oldest_first(std::span<const Candidate> candidates, Instant now);

/// The first candidate with a message. The others wait for it, even if it is not ready.
Turn in_order(std::span<const Candidate> candidates, Instant now);

}  // namespace adit::dispatch
