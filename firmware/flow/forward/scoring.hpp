#pragma once

#include <algorithm>
#include <chrono>
#include <deque>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "alarms/arrival.hpp"
#include "api/source.hpp"
#include "dispatch/reports.hpp"
#include "dispatch/runs.hpp"
#include "dispatch/verdicts.hpp"
#include "forward/channel.hpp"
#include "forward/clocks.hpp"
#include "forward/report_output.hpp"
#include "forward/traffic_counts.hpp"
#include "forward/uri_pace.hpp"
#include "icd/mapping.hpp"
#include "icd/scoring.hpp"
#include "intake/message_handler.hpp"
#include "intake/server.hpp"
#include "ledger/ledger.hpp"
#include "loop/loop.hpp"
#include "settings/settings.hpp"

namespace adit::forward {

class StatusClients {
 public:
  /// A client waits so long for a new status. Then it gets the last known one.
  static constexpr std::chrono::milliseconds kWait{100};

  void add(std::shared_ptr<intake::Responder> responder, loop::Instant now) {
    waiting_.push_back({std::move(responder), now + kWait});
  }
  bool empty() const { return waiting_.empty(); }
  /// The first end of a wait.
  std::optional<loop::Instant> first_end() const {
    if (empty()) return std::nullopt;
    return std::ranges::min_element(waiting_, {}, &Client::until)->until;
  }
  /// Answers the clients whose wait ends by `now`, or makes them wait until `longest` if that is later.
  void answer_due(loop::Instant now, loop::Instant longest, const intake::Answer& answer) {
    std::erase_if(waiting_, [&](Client& client) {
      if (client.until > now) return false;
      if (longest > now) {
        client.until = longest;
        return false;
      }
      client.responder->answer(answer);
      return true;
    });
  }
  void answer_all(const intake::Answer& answer) {
    for (const Client& client : std::exchange(waiting_, {})) client.responder->answer(answer);
  }

 private:
  struct Client {
    std::shared_ptr<intake::Responder> responder;
    loop::Instant until;  // end of the wait
  };
  std::deque<Client> waiting_;
};

/// The last known status of the run: for the page as it came, and for clients while Adit cannot ask, with
/// the effect of the reports that were answered since, and with its age (RFC 9111 5.1).
class StatusCache {
 public:
  static constexpr std::chrono::seconds kFresh{1};    // no request needed
  static constexpr std::chrono::seconds kOldest{60};  // better than no answer

  /// `body`: `run` as JSON. `now`: stamp clock.
  void on_status(std::string body, const icd::RunStatus& run, loop::Instant asked, icd::Stamp now);
  /// A report of the same run was answered: corrects the counts, and the clock if the two URIs may have the
  /// same one. `run_clock`: of the answer; 0: none.
  void add_report(const dispatch::Effect& effect, double run_clock, loop::Instant now);
  /// The status may have changed. It is still an answer.
  void mark_stale() { fresh_ = false; }

  const std::optional<icd::RunStatus>& run() const { return run_; }
  std::optional<alarms::ShownClock> run_clock(icd::Stamp now) const { return run_clock_.at(now); }
  bool is_fresh(loop::Instant now) const { return fresh_ && asked_ && now - *asked_ < kFresh; }
  /// nullopt if older than kOldest.
  std::optional<intake::Answer> answer(loop::Instant now) const;

 private:
  std::optional<icd::RunStatus> run_;
  alarms::RunClock run_clock_;
  std::optional<loop::Instant> asked_;
  bool fresh_ = false;
  std::optional<icd::RunStatus> corrected_;
  std::string body_;  // `corrected_` in the Command Post's form
};

/// The scoring endpoint. Sends reports one at a time by dispatch::Reports (promise 1), and requests the
/// status behind them. A status that no report needs gives way after a while.
///
/// The ICD limits API requests (5). A status keeps a report's distance after a report, unless it decides a
/// doubt. A report follows a status at once, until a 429 shows one limit over both. A status waits for queued
/// reports, because their answers show as much. If a client asks, one goes after kReportsInARow reports, but
/// not with one limit over both.
class Scoring {
 public:
  /// Without a known status the client waits for the request in flight, until so long after its start.
  static constexpr std::chrono::seconds kSlow{2};
  static constexpr std::chrono::seconds kAskEvery{10};  // longest interval between status requests
  /// A report waits so long for a status that no report needs. Then Adit gives up the status.
  static constexpr std::chrono::milliseconds kGivesWayAfter{200};
  static constexpr int kReportsInARow = 3;

  /// `clocks`: has the step of the stamp clock since the ledger was written. All outlive this.
  Scoring(loop::Loop& loop, uplink::Servers& servers, ledger::Ledger& ledger,
          const settings::Settings& settings, std::optional<icd::BearerToken> token, TrafficCounts& counts,
          std::mt19937_64& random, journal::Journal& journal, Clocks& clocks);

  void restore(const journal::HandoverState& carried) { pace_.restore(carried, loop_.now()); }
  void assume_just_sent() { pace_.assume_just_sent(loop_.now()); }
  /// For the operator's test.
  UriPace& status_pace() { return pace_.status_pace(); }
  void on_settings_changed();
  /// Answers in flight are the old endpoint's. Another endpoint clears the run's data. Clients keep waiting.
  void on_endpoint_changed(std::optional<icd::BearerToken> token);
  /// Call before start(): opens no connection and sends no request.
  void set_standby() { stopping_ = true; }
  /// Starts from the ledger, which has these `runs`, and connects.
  void start(std::vector<dispatch::Run> runs);

  void accept(const icd::ArtifactReport& report, const intake::Sender& sender,
              std::shared_ptr<intake::Responder> responder);
  void status(std::shared_ptr<intake::Responder> responder);
  /// Once a second.
  void tick();

  /// Returns the number of the changed report, or why the action failed.
  dispatch::Reports::Outcome decide(std::int64_t number, api::Action action) noexcept;
  /// Accepts the operator's report. Returns its number when it is on disk.
  dispatch::Reports::Outcome report(const icd::ArtifactReport& report, bool resubmit);
  /// Returns the number of the report that is sent instead.
  dispatch::Reports::Outcome correct(std::int64_t number, const icd::ArtifactReport& to) noexcept;
  std::int64_t begin_run() noexcept;

  /// Stops accepting and sending, and answers the clients of queued reports. False while an answer is
  /// awaited: call again.
  bool stop();
  /// The cable is in again: retries at once.
  void on_link_up();
  /// Also answers the client of the report in flight.
  void dismiss();

  const Channel& channel() const { return channel_; }
  const std::optional<icd::RunStatus>& run() const { return status_cache_.run(); }
  std::optional<alarms::ShownClock> run_clock() const { return status_cache_.run_clock(loop_.stamp_now()); }
  const dispatch::Reports& reports() const { return *reports_; }
  /// Why the ledger cannot be written, or "".
  const std::string& trouble() const { return output_.trouble(); }

 private:
  /// The status request in flight.
  struct AskedStatus {
    loop::Instant at;
    bool decides;  // a report waits for it
  };

  void correct_clock();
  /// Reports get stamps, because the stamp clock is never set and rules compare the times.
  dispatch::Time time() const { return {loop_.now(), loop_.stamp_now()}; }
  void on_new_command_post();
  void accept(const dispatch::PostedReport& posted, dispatch::ClientId client) noexcept;
  void schedule_status();
  void pump() noexcept;
  bool is_free(const dispatch::NextRequests& requests, loop::Instant now);
  void send(const dispatch::Report& report);
  void send_next();
  void on_report_answer(const uplink::Outcome& outcome);
  void classify_report(const uplink::Outcome& outcome);
  void correct_status(const dispatch::Report& answered);
  void ask_status(bool decides);
  void on_status_answer(const uplink::Outcome& outcome);
  void classify_status(const uplink::Outcome& outcome, loop::Instant asked);
  void watch_deadlines();
  void answer_clients(loop::Instant now);
  loop::Instant status_ready(const dispatch::NextRequests& requests) const;
  bool can_ask_soon(loop::Instant now) const;
  bool is_status_first(loop::Instant now) const;
  void on_deadline();
  std::string status_obstacle() const;
  intake::Answer known_or(intake::Answer failure) const;

  loop::Loop& loop_;
  ledger::Ledger& ledger_;
  const settings::Settings& settings_;
  TrafficCounts& counts_;
  ReportOutput output_;
  Clocks& clocks_;
  std::unique_ptr<dispatch::Reports> reports_;  // never null
  Channel channel_;
  ScoringPace pace_;
  loop::Source wake_, deadline_;

  StatusClients status_clients_;
  loop::Instant ask_at_ = loop::Instant::max();  // Adit needs a status from then on
  StatusCache status_cache_;
  std::int64_t status_run_ = 0;  // Run::number of the cached status
  std::optional<AskedStatus> asked_status_;
  bool is_status_wanted_ = false;  // a client has asked for a newer status than the last one
  int reports_in_a_row_ = 0;       // sent since the last request for a status
  loop::Instant reports_paused_until_{}, status_paused_until_{};  // by 503s
  bool stopping_ = false;
};

}  // namespace adit::forward
