#pragma once

#include <cstddef>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "simulation/client.hpp"

namespace adit::simulation {

class World;

/// What is in the box's folders, in bytes.
struct Stored {
  std::uint64_t state = 0, waiting = 0, journal = 0, others = 0;
};

/// What the page said at one moment.
struct Reading {
  std::size_t asked = 0, heard = 0;  // so many events had happened
  double at = 0;
  int life = 0;
  nlohmann::json view;       // of /adit/run
  std::string metrics = {};  // read right after it
  std::size_t measured = 0;  // events that had happened by then
  bool worked = false;       // a worker ended a job since it was asked
  Stored stored = {};        // when it was heard
  std::string lie = {};      // in what lights or STATUS disagreed with it for as long as they may not
};

/// Somebody who looks at the page every few seconds.
class Reader {
 public:
  /// Looks until then. `world` outlives this.
  Reader(World& world, double until);
  /// From `from` on looks whether anything waits still, and tells when nothing does, or when it is `end`.
  void wait_for_rest(double from, double end, std::function<void()> rested);
  const std::vector<Reading>& readings() const { return readings_; }

 private:
  void look();
  void look_at_rest();
  void look_at(const char* path, std::function<void(const std::string& body)> got);
  void viewed(const std::string& body);
  void look_again(const std::string& lie);

  World& world_;
  Client client_;
  double until_, end_ = 0;
  std::function<void()> rested_;
  int again_ = 0;     // how often the same lie was seen
  double since_ = 0;  // first
  std::string lie_;
  std::size_t asked_ = 0;
  std::uint64_t jobs_ended_ = 0;  // when it was asked
  std::vector<Reading> readings_;
};

}  // namespace adit::simulation
