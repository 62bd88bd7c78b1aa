#include "forward/run_news.hpp"

#include <utility>

#include "forward/channel.hpp"

namespace adit::forward {

RunNews::Change RunNews::look(const dispatch::Reports& reports) {
  const dispatch::Run& run = reports.run();
  const std::int64_t before = std::exchange(run_, run.number);
  const bool is_heard = status_came(run);
  if (before == 0) return Change::FirstLook;
  if (before == run.number) {
    const bool is_likely = is_heard && is_by_settings(run) && dispatch::tells_of_another(run);
    return is_likely ? Change::LikelyAnother : Change::None;
  }
  next_map_ = next_map_after(before, reports);
  return Change::Another;
}

/// Runs may have begun before this process or before a change of the Command Post.
dispatch::NextMap RunNews::next_map_after(std::int64_t before, const dispatch::Reports& reports) const {
  const dispatch::Run* const known = reports.runs().find(before);
  // The run goes on although another one seemed to begin.
  if (reports.runs().may_be(before, reports.run().number)) return dispatch::NextMap::MayBeTheSame;
  const bool is_here = known != nullptr && reports.runs().is_here(before) && is_by_settings(reports.run());
  return is_here ? dispatch::next_map(*known, reports.run()) : dispatch::NextMap::MayBeTheSame;
}

/// The present run is at the Command Post in the settings.
bool RunNews::is_by_settings(const dispatch::Run& run) const {
  return run.post == address_text(settings_.command_post.scoring);
}

/// True if the clock of the status has changed.
bool RunNews::status_came(const dispatch::Run& run) {
  const auto& clock = run.status_clock;
  const double shows = clock ? clock->shows : 0;
  return std::exchange(clock_shown_, shows) != shows;
}

}  // namespace adit::forward
