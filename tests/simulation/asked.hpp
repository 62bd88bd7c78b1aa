#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "simulation/history.hpp"
#include "simulation/messages.hpp"

namespace adit::simulation {

/// Seconds in which what nobody waits for any more may still be accepted: it may stand at the door until the
/// next life begins, and be read by it.
constexpr double kForgotten = 12;

/// One request of a client, and what became of it. Where the client heard nothing it is unknown: it may have
/// counted at any time from when it began until it ended, or never.
struct Asked {
  std::string path;
  std::vector<Item> items;
  double began = 0;
  double ended = 0;  // after this it is not accepted any more
  bool whole = false;
  int status = 0;  // 0: the client heard nothing

  bool accepted() const { return status == 200; }
  bool may_count() const { return accepted() || (status == 0 && whole); }
};

/// Reports that were posted, by a client or on the page, until the Command Post has answered them with 2xx
/// or the operator has called them done or withdrawn.
class OpenReports {
 public:
  void add(const Event& event);
  bool any() const { return !open_.empty(); }
  /// One has left, or some of it, and no answer told what became of it.
  bool in_doubt() const { return !doubts_.empty(); }

 private:
  std::map<std::uint64_t, std::int64_t> posted_,
      sent_;  // serials, by the client's request and the connection
  std::set<std::int64_t> known_, open_, taken_, doubts_;  // serials
  std::map<std::int64_t, double> told_;                   // serials that were answered, and when
  bool is_odd_ = false;                                   // the answer under way is not the report's own
  bool is_switched_ = false;                              // the course was, so that a doubt may be elsewhere
};

/// Those of that path, but for bad messages, in the order in which they began.
std::vector<Asked> asked_in(const std::vector<Event>& events, const std::string& path);

}  // namespace adit::simulation
