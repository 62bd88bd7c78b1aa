#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "simulation/history.hpp"

namespace adit::simulation {

/// Decides which run a report was meant for: the current run of the Command Post that the settings named
/// when it was posted.
class IntendedRuns {
 public:
  /// Call for each event in order.
  void add(const Event& event);
  /// Whether a report that is recorded now, in the current run at that Command Post, was meant for that
  /// run. Also true while the end of the previous run may be unnoticed.
  bool is_intended(std::int64_t serial, int place, double now) const;
  /// Whether the operator's *send* was in flight while the course was switched. His decision was then about
  /// the course before.
  bool is_sent_across(std::int64_t serial) const;
  /// Whether the operator's *send* was requested in that time.
  bool is_sent_within(std::int64_t serial, double from, double until) const;

 private:
  struct Posting {
    double at = 0;
    std::set<int> places;
    bool unheard = false;  // no run there was known: it is meant for the first known one
    std::uint64_t request = 0;
    bool is_word = false;  // it is the operator's *send*
  };
  struct Open {
    std::int64_t serial = 0;
    double until = 0;
  };
  void switched(const Event& event);
  void posted(const Event& event);
  /// Adds the places that the settings name at this time to open postings.
  void reach(double now);
  std::set<int> places(double now) const;

  std::map<std::int64_t, std::vector<Posting>> postings_;
  std::map<std::uint64_t, Open> open_;  // requests that may still count
  std::map<int, double> run_began_;
  std::set<int> heard_, heard_before_;  // runs known now, and at the start of this process
  bool unwritten_ = false;              // the ledger could not be written in this process
  int place_ = 0, before_ = 0;
  double switched_ = -1e9;
  bool unsure_ = false;  // the last switch may have failed
};

/// The index of the Command Post in a run's name.
int place_of(const std::string& run);

}  // namespace adit::simulation
