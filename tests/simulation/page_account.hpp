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

/// Whose messages of which URI; markers are nobody's.
struct Stream {
  std::string path, who;
  friend auto operator<=>(const Stream&, const Stream&) = default;
};
Stream stream_of(const std::string& path, const std::string& who);

/// What happened between two moments, at least and at most: what the events do not order counts as either.
struct Range {
  std::int64_t least = 0, most = 0;
  bool has(std::int64_t number) const { return least <= number && number <= most; }
};

/// What the history says of the team's messages and of the Command Post's answers, to be counted between two
/// readings of the page.
class PageAccount {
 public:
  /// `events` outlive this.
  explicit PageAccount(const std::vector<Event>& events);

  /// Moments: a reading was asked for before event `asked`, and its answer heard before event `heard`.
  struct Moment {
    std::size_t asked = 0, heard = 0;
  };
  Range accepted(const Stream& stream, Moment from, Moment to) const;
  Range forwarded(const Stream& stream, Moment from, Moment to) const;
  /// Of a robot's poses: seconds since the newest one that was delivered was posted, at least and at most.
  struct Age {
    double least = 0, most = std::numeric_limits<double>::infinity();
  };
  Age age(const Stream& stream, Moment at) const;
  /// Answers of that kind of an endpoint, "scoring" or "mapping".
  Range throttled(const std::string& endpoint, Moment from, Moment to) const;
  Range foreign(const std::string& endpoint, Moment from, Moment to) const;

  /// Where its counts restarted, or may have: the last time before a moment.
  std::size_t begun(Moment at) const;

 private:
  static constexpr std::size_t kNever = std::numeric_limits<std::size_t>::max();
  struct Posted {
    std::size_t asked = 0, ended = kNever;
    int status = 0;  // 0: no answer was heard
  };
  using Places = std::vector<std::size_t>;  // of events, in order
  static Range between(const Places& places, Moment from, Moment to);
  void read_team(std::size_t place, const Event& event);
  void end_forgotten(std::size_t place, const Event& event);
  void end(std::size_t place, const Event& event);
  void read_upstream(std::size_t place, const Event& event);
  void was_taken(std::size_t place, const Stream& stream, std::int64_t pose);

  const std::vector<Event>& events_;
  std::map<Stream, std::vector<Posted>> posted_;
  std::map<std::uint64_t, std::vector<std::pair<Stream, std::size_t>>> open_;  // requests: where in posted_
  std::deque<std::pair<double, std::uint64_t>> gone_;                          // when, and which request
  /// A pose that was taken, which goes along with each state from then on.
  struct Told {
    std::int64_t pose = 0;  // its serial
    int times = 0;          // it counted as forwarded
    bool is_of_before = false;
  };
  std::map<std::pair<Stream, std::int64_t>, int> poses_;               // how often each was posted
  std::map<std::uint64_t, std::map<Stream, std::int64_t>> under_way_;  // by connection: with a pose's serial
  std::map<Stream, Told> told_;
  std::map<Stream, Places> forwarded_, may_be_forwarded_;
  std::map<std::pair<Stream, std::int64_t>, double> posted_at_;  // each pose, for the first time
  std::map<std::pair<Stream, std::size_t>, double> age_from_;    // by a place in forwarded_
  std::map<std::string, Places> throttled_, foreign_;
  Places begun_;
  std::vector<double> recorded_until_;  // for each of begun_: the process before recorded all until then
  Places forgotten_;                    // where what a process recorded was lost, or is of another course
};

/// "scoring" or "mapping".
std::string endpoint_of(const std::string& path);

}  // namespace adit::simulation
