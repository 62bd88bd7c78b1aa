#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "rehearsal/command_post/arrivals.hpp"
#include "rehearsal/command_post/document.hpp"
#include "rehearsal/command_post/endpoint.hpp"
#include "rehearsal/command_post/fault.hpp"
#include "rehearsal/command_post/record.hpp"
#include "rehearsal/command_post/run.hpp"
#include "rehearsal/command_post/server.hpp"

namespace adit::rehearsal {

/// What the command line says.
struct Options {
  Address scoring;
  Address mapping;
  std::optional<Address> control;
  std::string secrets;
  std::string artifacts;   // "": none
  std::string transcript;  // "": none
  std::uint64_t transcript_megabytes = 2000;
  Manner manner = Manner::Strict;
  bool slash = false;           // each path has to end with one
  bool serial = false;          // each endpoint serves one connection at a time
  std::size_t limit_bytes = 0;  // of a body; 0: only the endpoints' own limits
  RunPlan run;
  std::optional<double> rate;            // Hz; absent: by the manner
  bool one_api_limit = false;            // over statuses and reports together
  std::optional<Counted> counted;        // how the mapping rate is measured; absent: by the manner
  double link = 0;                       // Mbit/s over both endpoints; 0: no limit
  std::vector<std::string> roster;       // the robots' names; empty: any
  std::vector<std::string> faults;       // "reports:record-then-drop", not yet understood
  std::vector<std::string> fault_rates;  // "reports:record-then-drop=0.1", not yet understood
  std::uint64_t seed = 1;                // of what happens at random
  bool not_started = false;
  bool verbose = false;
  bool help = false, version = false;
};

/// The tokens that the two endpoints know the team by.
struct Secrets {
  std::string scoring;
  std::string mapping;
};

/// A whole Command Post, but for its sockets: both endpoints, the run, the record and the transcript. Safe
/// for use by several threads.
class CommandPost {
 public:
  /// `transcript` may be null.
  CommandPost(const Options& options, const Secrets& secrets, std::vector<Artifact> artifacts,
              std::unique_ptr<Transcript> transcript);

  /// Each decides what is done about a request to that endpoint and writes it down, before anything is sent.
  /// The request has to outlive the outcome, which may be decided later.
  Outcome scoring(const Request& request);
  Outcome mapping(const Request& request);

  /// The control port (README.md, 'The control port'). POST /posted, of adit-robots, is described at
  /// Arrivals::told.
  Outcome control(const Request& request);

  Faults& faults() { return faults_; }
  std::string summary() const { return record_.summary(run_.standing(Clock::now())) + arrivals_.table(); }
  std::string killed_by() const { return record_.killed_by(); }

 private:
  struct Side {
    std::unique_ptr<Endpoint> endpoint;
    const char* name;
  };

  bool redirects(const Request& request) const;
  bool is_too_large(const Request& request) const {
    return options_.limit_bytes > 0 && !request.fault && request.body.size() > options_.limit_bytes;
  }
  void note_order(const Request& request, const Fault& fault, Judgement& judgement);
  void note_names(Judgement& judgement) const;
  Outcome last_answer_to(Aim aim);
  void note_answer(Aim aim, const Outcome& outcome);
  Outcome receive(Side& side, std::optional<Aim> aim, const Request& request);
  Judgement judge(Side& side, std::optional<Aim> aim, const Fault& fault, const Request& request);
  Outcome decide(Side& side, std::optional<Aim> aim, const Fault& fault, const Request& request);
  /// Another sender on the same token submits a report; if `sent` holds nothing, one that no artifact is
  /// near. `sent`: numbers x, y, z and a text type. Gives the report as it was recorded.
  OrderedJson other_sender(const std::optional<Json>& sent);
  Outcome show_arrivals() const;
  OrderedJson record() const;
  void keep(OrderedJson report, const char* by, const OrderedJson& request);
  void show(std::uint64_t number, const Request& request, const Judgement& judgement) const;

  const Options options_;
  Run run_;
  Record record_;
  Faults faults_;
  Arrivals arrivals_;
  Side scoring_;
  Side mapping_;
  std::unique_ptr<Transcript> transcript_;
  /// Held from the moment at which the run counts a report until the record and the transcript have it, and
  /// while a status is answered. No status therefore counts a report that the record does not have.
  mutable std::mutex scoring_mutex_;
  std::mutex answers_mutex_;
  std::array<std::optional<Answer>, kAims.size()> answers_;  // the last good one of each aim
  std::optional<Clock::time_point> reported_;  // when the last report that was answered had arrived
  std::atomic<std::uint64_t> number_;
  std::atomic<int> by_others_ = 0;
};

}  // namespace adit::rehearsal
