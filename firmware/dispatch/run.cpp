#include "dispatch/run.hpp"

namespace adit::dispatch {

Clock seen_again(const std::optional<Clock>& seen, double shows) {
  if (!seen) return {.shows = shows};
  return {.shows = shows, .runs = seen->runs || shows > seen->shows};
}

}  // namespace adit::dispatch
