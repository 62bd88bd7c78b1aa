#pragma once

#include <cstddef>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "simulation/client.hpp"

namespace adit::simulation {

class World;

/// Bytes in the box's directories.
struct Stored {
  std::uint64_t state = 0, waiting = 0, journal = 0, others = 0;
};

/// The page's content at one moment.
struct Reading {
  std::size_t asked = 0, heard = 0;  // numbers of events by then
  double at = 0;
  int process = 0;
  nlohmann::json view;          // of /adit/run
  std::string metrics = {};     // read right after the view
  std::size_t measured = 0;     // number of events by then
  bool worked = false;          // a worker ended a job since the request
  Stored stored = {};           // when the answer was heard
  std::string difference = {};  // lasting difference from the lights or STATUS
};

/// A client that reads the page every few seconds.
class Reader {
 public:
  /// Reads until `until`. `world` must outlive it.
  Reader(World& world, double until);
  /// From `from` on, calls `rested` when nothing is queued, at `end` at the latest.
  void wait_for_rest(double from, double end, std::function<void()> rested);
  const std::vector<Reading>& readings() const { return readings_; }

 private:
  void look();
  void look_at_rest();
  void look_at(const char* path, std::function<void(const std::string& body)> got);
  void viewed(const std::string& body);
  void confirm(const std::string& difference);

  World& world_;
  Client client_;
  double until_, end_ = 0;
  std::function<void()> rested_;
  int times_seen_ = 0;  // how often the same difference was seen
  double since_ = 0;    // when it was first seen
  std::string difference_;
  std::size_t asked_ = 0;
  std::uint64_t jobs_ended_ = 0;  // at the request
  std::vector<Reading> readings_;
};

}  // namespace adit::simulation
