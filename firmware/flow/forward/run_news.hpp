#pragma once

#include <cstdint>

#include "dispatch/reports.hpp"
#include "settings/settings.hpp"

namespace adit::forward {

/// Notices that the present run is another one, or that the Command Post may have another map.
class RunNews {
 public:
  enum class Change : std::uint8_t {
    None,
    FirstLook,
    LikelyAnother,  // the last status tells of another run, which is not yet certain
    Another,        // next_map() says what the Command Post has of the map
  };

  /// `settings` outlives this.
  explicit RunNews(const settings::Settings& settings) : settings_(settings) {}

  /// The change since the last look.
  Change look(const dispatch::Reports& reports);
  dispatch::NextMap next_map() const { return next_map_; }

 private:
  dispatch::NextMap next_map_after(std::int64_t before, const dispatch::Reports& reports) const;
  bool is_by_settings(const dispatch::Run& run) const;
  bool status_came(const dispatch::Run& run);

  const settings::Settings& settings_;
  std::int64_t run_ = 0;    // at the last look; 0: none yet
  double clock_shown_ = 0;  // clock of the last status at the last look
  dispatch::NextMap next_map_ = dispatch::NextMap::MayBeTheSame;
};

}  // namespace adit::forward
