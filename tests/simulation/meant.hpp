#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "simulation/history.hpp"

namespace adit::simulation {

/// Which run a report was meant for: what is posted is meant for the Command Post that the settings name, and
/// for the run that is on there.
class Meant {
 public:
  /// Each event in its order.
  void add(const Event& event);
  /// Whether a report that is recorded at that moment, in the run of that Command Post that is on, was meant
  /// for it; or nobody may have noticed yet that the run before is over.
  bool is_meant(std::int64_t serial, int place, double now) const;
  /// Whether the operator's *send* was on its way while the course was switched: he had judged it for the one
  /// before.
  bool is_sent_across(std::int64_t serial) const;

 private:
  struct Posting {
    double at = 0;
    std::set<int> places;
    bool unheard = false;  // nothing had been heard of a run there: it is meant for the first that is
    std::uint64_t request = 0;
    bool is_word = false;  // the operator's
  };
  struct Open {
    std::int64_t serial = 0;
    double until = 0;
  };
  void switched(const Event& event);
  void posted(const Event& event);
  /// Adds the places that the settings name now to what is posted at this time.
  void reach(double now);
  std::set<int> places(double now) const;

  std::map<std::int64_t, std::vector<Posting>> postings_;
  std::map<std::uint64_t, Open> open_;  // requests that may still count
  std::map<int, double> run_began_;
  std::set<int> heard_, heard_before_;  // before this life
  bool unwritten_ = false;              // the ledger could not be written in this life
  int place_ = 0, before_ = 0;
  double switched_ = -1e9;
  bool unsure_ = false;  // whether the last switch was made
};

/// Of a run's name.
int place_of(const std::string& run);

}  // namespace adit::simulation
