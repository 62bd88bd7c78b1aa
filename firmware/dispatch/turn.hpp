#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <span>

namespace adit::dispatch {

using Instant = std::chrono::steady_clock::time_point;

/// One kind of message that shares a connection with others.
struct Candidate {
  std::optional<Instant> oldest;  // when the oldest news it has was accepted; nothing: it has no news
  Instant ready;                  // before this its rate limit or its back-off forbids it
};

/// Whose turn it is, or when to ask again.
struct Turn {
  std::optional<std::size_t> candidate;  // index of who may send now
  std::optional<Instant> wake;  // nobody may: the earliest time somebody will; nothing: nobody has news
};

/// The oldest news first, among those that may send now.
Turn oldest_first(std::span<const Candidate> candidates, Instant now);

/// Strictly in order: a later candidate waits while an earlier one has news, even if that may not send yet
/// (a status is never asked for ahead of a waiting report).
Turn in_order(std::span<const Candidate> candidates, Instant now);

}  // namespace adit::dispatch
