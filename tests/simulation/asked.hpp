#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "simulation/history.hpp"
#include "simulation/messages.hpp"

namespace adit::simulation {

/// Seconds in which a request may still be accepted after its client has gone: its connection may wait at
/// the door until the next process reads it.
constexpr double kForgotten = 12;

/// One request of a client and its outcome. If the client heard no answer, the outcome is unknown: the
/// request may have counted at any time between `began` and `ended`, or never.
struct Asked {
  std::string path;
  std::vector<Item> items;
  double began = 0;
  double ended = 0;     // the request is not accepted after this time
  double whole_at = 0;  // when its last byte was sent
  bool whole = false;
  int status = 0;  // 0: the client heard no answer

  bool accepted() const { return status == 200; }
  bool may_count() const { return accepted() || (status == 0 && whole); }
};

/// Whether a newer message of one client certainly overtook an older one: its clock ran on between them, and
/// the upload of the older one began before the newer one was whole. `older`, `newer`: their items.
bool is_overtaken(const Asked& first, const Item& older, const Asked& second, const Item& newer);

/// Reports that a client or the operator posted, until the Command Post has answered them with 2xx or the
/// operator has settled or withdrawn them.
class OpenReports {
 public:
  void add(const Event& event);
  bool any() const { return !open_.empty(); }
  /// A report has left, or a part of it, and no answer told whether it was recorded.
  bool in_doubt() const { return !doubts_.empty(); }

 private:
  std::map<std::uint64_t, std::int64_t> posted_,
      sent_;  // serials, by the client's request and the connection
  std::set<std::int64_t> known_, open_, recorded_, doubts_;  // serials
  std::set<std::int64_t> repeated_;          // open after a switch of the course, and not sent since
  std::map<std::int64_t, double> answered_;  // serials that were answered, and when
  bool is_odd_ = false;                      // the answer in flight is not the report's own
  bool is_switched_ = false;  // the course was switched, so a report in doubt may be at the other course
};

/// The requests for `path`, without bad messages, in the order in which they began.
std::vector<Asked> asked_in(const std::vector<Event>& events, const std::string& path);

}  // namespace adit::simulation
