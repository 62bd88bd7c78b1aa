#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <stop_token>
#include <string>

#include "rehearsal/robots/client.hpp"
#include "rehearsal/robots/desk.hpp"
#include "rehearsal/robots/map_maker.hpp"
#include "rehearsal/robots/posted.hpp"
#include "rehearsal/robots/robot.hpp"
#include "rehearsal/robots/scene.hpp"

namespace adit::robots {

/// Sleeps until `time`, or less where `stop` is requested.
inline void pause_until(std::chrono::steady_clock::time_point time, const std::stop_token& stop) {
  std::mutex mutex;
  std::condition_variable_any never;
  std::unique_lock lock(mutex);
  (void)never.wait_until(lock, stop, time, [] { return false; });
}

/// A robot and the software on it: walks, and posts what it knows at the rates of the field. Poses 5 or 10
/// times a second, markers every 2 s, and the maps of its offer.
class Explorer {
 public:
  /// `cave`, `style`, `client`, `desk` and `posted` outlive the explorer.
  Explorer(const Cave& cave, std::uint64_t seed, std::size_t index, std::string name, const Style& style,
           const MapOffer& offer, Client& client, OperatorDesk& desk, Posted& posted);

  void work(double metres_per_second, const std::stop_token& finish);

 private:
  using Clock = std::chrono::steady_clock;

  double stamp(Clock::time_point now) const;
  MapTime map_time(Clock::time_point now) const;
  void post_grid(Clock::time_point now);
  void post_cloud(Clock::time_point now);
  void report_sightings(double seconds);

  const Cave& cave_;
  std::size_t index_;
  std::string name_;
  const Style& style_;
  Client& client_;
  OperatorDesk& desk_;
  Posted& posted_;
  Random random_;
  Robot robot_;
  MarkerScene scene_;
  MapOffer offer_;
  MapMaker maps_;
  double clock_at_start_;  // what this robot's own clock says, which is nobody else's
  Clock::time_point start_;
};

}  // namespace adit::robots
