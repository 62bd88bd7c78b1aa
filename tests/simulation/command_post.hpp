#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "simulation/counting.hpp"
#include "simulation/faults.hpp"
#include "simulation/http.hpp"
#include "simulation/messages.hpp"
#include "simulation/network.hpp"
#include "simulation/random.hpp"
#include "simulation/scoreboard.hpp"

namespace adit::simulation {

/// Event::who of a fault: an answer repeats the one before, and nothing is recorded.
inline constexpr const char* kRepeats = "Repeats";

/// Event::who of a fault: the late reporter's answer is lost.
inline constexpr const char* kLate = "Late";

/// Event::who of a fault: a message of a robot that the Command Post does not know is rejected. Event::text
/// is the robot.
inline constexpr const char* kUnregistered = "Unregistered";
/// Event::who of a fault: a proxy did not let a map through.
inline constexpr const char* kTooLarge = "TooLarge";

/// Both endpoints of a Command Post that follows the ICD to the letter, with the faults of one run
/// (faults.hpp, counting.hpp, scoreboard.hpp). The seed also draws these habits:
/// - In one of eight worlds it answers 200 to an incomplete message and resets the connection. In another one
/// of eight it repeats the answer to the report before and makes no record. In another it answers 500 to 30
/// to 80 % of the maps, and records half of these.
/// - Half of the answers 502, 503 and 504 have a Retry-After: a number, a date beside a Date that is months
/// off, or a value beyond int32. In 15 % of the runs good answers are compressed.
/// - In a quarter of the runs a proxy answers 413 with a web page to a map above 0.4 to 2.4 kB, except to one
/// that a client posted as it is. In three of ten of these runs that is no exception until the trouble ends;
/// in one of five it resets the connection until then.
/// - In one of twenty worlds maps are large (60 to 480 kB of noise in clouds, grids of 95 kB), and the proxy
/// has a limit of 66 to 356 kB for all maps.
/// - In one of five runs each endpoint is serial. In three of ten both have one address and port.
/// - In one of six runs a web server answers in place of scoring for up to 15 s. Scoring may answer pages,
/// 404 or a redirect (307, 308) to one form of its paths.
/// - In one of five runs it does not know one robot for a time, and rejects its states and markers.
class CommandPost final : public Host {
 public:
  static constexpr std::uint16_t kScoring = 8000, kMapping = 8001;  // ports

  /// `place`: index of the Command Post, from 0. `world` must outlive it.
  CommandPost(World& world, const Faults& faults, double trouble_for, int place = 0);

  /// Ends all faults.
  void calm();

  std::optional<int> connecting(const uplink::Endpoint& endpoint) override;
  std::unique_ptr<Peer> connected(const uplink::Endpoint& endpoint, Link& link) override;

 private:
  class Conversation;
  class Reader;
  class SerialReader;
  using Accepted = std::deque<std::shared_ptr<Conversation>>;
  void asked(const HttpMessage& request, const WhenLeft& left, Link& link);
  bool is_single(const std::vector<Item>& sent) const;
  bool cuts_large(const HttpStream& stream, Link& link);
  bool is_too_large(const HttpMessage& request, Link& link);
  bool redirects(const HttpMessage& request, Link& link);
  bool refuses(const HttpMessage& request, const WhenLeft& left, Link& link);
  bool has_page_for(const HttpMessage& request, Link& link);
  bool rejects_robot(const HttpMessage& request, Link& link);
  bool is_beyond_one_limit(const HttpMessage& request, const WhenLeft& left);
  void answer(const HttpMessage& request, Link& link);
  bool loses_late_answer(const HttpMessage& request, Link& link);
  void may_answer_early(const HttpMessage& head, Link& link);
  void misbehave(Fault fault, const HttpMessage& request, Link& link);
  std::string bad_answer(Fault fault, const HttpMessage& request);
  /// Records the items of the request and returns the answer.
  std::string take(const HttpMessage& request);
  /// Returns the answer to the report before, and records nothing.
  std::optional<std::string> repeat_last_answer(const Item& item);
  void take_later(const HttpMessage& request, double within);
  void plan_periods(Fault fault, double trouble_for);
  void begin(Fault period, double takes);
  void plan_clerk(double trouble_for);
  void plan_portal(double trouble_for);
  void plan_registry(double trouble_for);
  void let_clerk(bool grants);
  void begin_run();
  void cut_all();
  bool is_on(Fault period) const { return on_.contains(period); }
  void note(Fault fault, const std::string& path);

  World& world_;
  Faults faults_;
  Random random_, early_, repeating_, pausing_, failing_;
  const bool gzips_;                    // its answers, though Adit asks for none
  double answers_early_;                // probability per piece of a request
  double repeats_;                      // probability per report
  double fails_maps_;                   // probability of a 500 per map
  std::size_t largest_ = SIZE_MAX;      // bytes of a map that a proxy before it lets through
  bool is_below_single_ = false;        // also if one posted map alone is larger, until calm()
  bool resets_large_ = false;           // in place of an answer, until calm()
  const bool has_one_limit_;            // one rate limit over reports and statuses
  std::optional<loop::Instant> asked_;  // when the last accepted report or status left
  const bool is_serial_;                // each server reads one connection at a time
  /// The connections of each serial server, the one that is read first.
  std::map<std::pair<std::string, std::uint16_t>, Accepted> accepted_;
  Scoreboard scoreboard_;
  std::uint64_t connection_ = 0;  // of the last request
  Counting counting_;
  /// The form of scoring's paths. The official server knows both.
  enum class Slash : std::uint8_t { Either, Unknown, Wanted } slash_;
  int redirects_reports_ = 0;  // to a path with a slash, by this status; 0: never
  bool has_portal_ = false;    // a web server answers in place of scoring
  std::string unregistered_;   // its states and markers are rejected; "": all robots are known
  std::string rejection_;      // the answer to them
  bool calm_ = false;
  bool is_late_lost_ = false;  // the answer to the late reporter was lost
  std::set<Fault> on_;         // faults that last for a period
  std::vector<std::weak_ptr<Link>> links_;
};

}  // namespace adit::simulation
