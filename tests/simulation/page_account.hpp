#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "simulation/history.hpp"

namespace adit::simulation {

/// Whose messages, and of which URI. Markers have no sender.
struct Stream {
  std::string path, who;
  friend auto operator<=>(const Stream&, const Stream&) = default;
};
Stream stream_of(const std::string& path, const std::string& who);

/// The least and the most that may have happened between two moments. An event whose order is unknown
/// counts in the most only.
struct Range {
  std::int64_t least = 0, most = 0;
  bool has(std::int64_t number) const { return least <= number && number <= most; }
};

/// Counts the team's messages and the Command Post's answers between two readings of the page.
class PageAccount {
 public:
  /// `events` must outlive this.
  explicit PageAccount(const std::vector<Event>& events);

  /// A reading was requested before event `asked`, and its answer was heard before event `heard`.
  struct Moment {
    std::size_t asked = 0, heard = 0;
  };
  Range accepted(const Stream& stream, Moment from, Moment to) const;
  Range forwarded(const Stream& stream, Moment from, Moment to) const;
  /// Limits, in seconds, of the time since a robot's newest delivered pose was posted.
  struct Age {
    double least = 0, most = std::numeric_limits<double>::infinity();
  };
  Age age(const Stream& stream, Moment at) const;
  /// The number of such answers of an endpoint, "scoring" or "mapping".
  Range throttled(const std::string& endpoint, Moment from, Moment to) const;
  Range foreign(const std::string& endpoint, Moment from, Moment to) const;

  /// The last event before a moment at which the counts restarted, or may have.
  std::size_t begun(Moment at) const;

 private:
  static constexpr std::size_t kNever = std::numeric_limits<std::size_t>::max();
  struct Posted {
    std::size_t asked = 0, ended = kNever;
    int status = 0;  // 0: the client heard no answer
  };
  using Places = std::vector<std::size_t>;  // indices of events, ascending
  static Range between(const Places& places, Moment from, Moment to);
  void read_team(std::size_t place, const Event& event);
  void end_forgotten(std::size_t place, const Event& event);
  void end(std::size_t place, const Event& event);
  void read_upstream(std::size_t place, const Event& event);
  void count_delivery(std::size_t place, const Stream& stream, std::int64_t pose);

  const std::vector<Event>& events_;
  std::map<Stream, std::vector<Posted>> posted_;
  std::map<std::uint64_t, std::vector<std::pair<Stream, std::size_t>>>
      open_;                                           // by request: its entries in posted_
  std::deque<std::pair<double, std::uint64_t>> gone_;  // when a client left, and its request
  /// A delivered pose, which is sent again with each later state.
  struct Delivered {
    std::int64_t pose = 0;  // its serial
    int times = 0;          // how often it counted as forwarded
    bool is_of_before = false;
  };
  std::map<std::pair<Stream, std::int64_t>, int> poses_;  // how often each was posted
  std::map<std::uint64_t, std::map<Stream, std::int64_t>>
      under_way_;  // by connection: serials of poses in flight
  std::map<Stream, Delivered> delivered_;
  std::map<Stream, Places> forwarded_, may_be_forwarded_;
  std::map<std::pair<Stream, std::int64_t>, double> posted_at_;  // when each pose was first posted
  std::map<std::pair<Stream, std::size_t>, double> age_from_;    // by an index in forwarded_
  std::map<std::string, Places> throttled_, foreign_;
  Places begun_;
  std::vector<double>
      recorded_until_;  // for each of begun_: the process before recorded everything until then
  Places sent_again_;   // where the operator asked for a rejected message to be sent
  Places forgotten_;    // where a process lost its records, or the course changed
};

/// "scoring" or "mapping".
std::string endpoint_of(const std::string& path);

}  // namespace adit::simulation
