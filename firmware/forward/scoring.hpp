#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <random>
#include <string>

#include "alarms/run_clock.hpp"
#include "api/source.hpp"
#include "dispatch/reports.hpp"
#include "forward/channel.hpp"
#include "forward/clocks.hpp"
#include "forward/known_status.hpp"
#include "forward/record.hpp"
#include "forward/report_output.hpp"
#include "forward/scoring_pace.hpp"
#include "icd/artifact_report.hpp"
#include "icd/run_status.hpp"
#include "intake/desk.hpp"
#include "ledger/ledger.hpp"
#include "loop/loop.hpp"
#include "settings/settings.hpp"

namespace adit::forward {

/// The scoring endpoint: sends reports, one at a time, by the rules of dispatch::Reports (promise 1), and
/// asks for the run's status, but never ahead of a report that may go. A status that no report needs gives
/// way to a report if it is not answered in time.
///
/// The ICD's rate (5) is of API requests, and a report's answer tells what a status would: the status follows
/// a report no sooner than another report would, unless it decides what became of one. A report follows a
/// status at once, until a 429 shows that the Command Post has one limit over both.
class Scoring {
 public:
  /// So long a client that asks for the status waits for the Command Post; then it gets the last known one.
  static constexpr std::chrono::milliseconds kAskerWaits{100};
  /// If none is known, it waits for the answer under way, until so long after that was asked for.
  static constexpr std::chrono::seconds kSlow{2};
  static constexpr std::chrono::seconds kAskEvery{10};  // the status is asked for at least this often
  /// So long a report waits for the answer to a status that no report needs; then that is given up.
  static constexpr std::chrono::milliseconds kGivesWayAfter{200};

  /// `clocks`: tell how far the clock that the ledger was written by has leapt since. All outlive this.
  Scoring(loop::Loop& loop, ledger::Ledger& ledger, const settings::Settings& settings,
          std::optional<icd::BearerToken> token, Record& record, std::mt19937_64& random,
          journal::Journal& journal, Clocks& clocks);

  void carry_on(const journal::Carried& carried) { pace_.carry_on(carried, loop_.now()); }
  /// As if something had just been sent: the flow before may have.
  void hold_back() { pace_.hold_back(loop_.now()); }
  /// Of the run's status, which the operator's test asks for too.
  UriPace& status_pace() { return pace_.of_status(); }
  /// The settings have changed.
  void settings_changed();
  /// The endpoint's address, token or way has changed. The answer under way still comes from the old one. If
  /// the place is another, what is known of the run is forgotten; clients whose reports wait go on waiting.
  void endpoint_changed(std::optional<icd::BearerToken> token);
  /// Before start(): connects to nobody, and sends nothing.
  void stand_by() { stopping_ = true; }
  /// Begins with what the ledger holds, and connects.
  void start();

  void take(const icd::ArtifactReport& report, const intake::Sender& sender,
            std::shared_ptr<intake::Responder> responder);
  void status(std::shared_ptr<intake::Responder> responder);
  /// Once a second.
  void tick();

  /// An operator's action on a report; gives the number of the report that it moved, or a sentence why not.
  dispatch::Reports::Outcome judge(std::int64_t number, api::Action action) noexcept;
  /// The operator's own report, as if a client had posted it; gives its number once it is on disk.
  dispatch::Reports::Outcome report(const icd::ArtifactReport& report, bool resubmit);
  std::int64_t begin_run() noexcept;

  /// Sends and takes nothing more; clients whose reports wait are told so. False while an answer is still
  /// awaited. Called again until it is true or there is no more time.
  bool stop();
  /// The cable is in again: nothing rests any longer because sending failed without it.
  void link_is_back();
  /// Also tells the client whose report is still under way.
  void dismiss();

  const Channel& channel() const { return channel_; }
  const std::optional<icd::RunStatus>& run() const { return run_; }
  std::optional<alarms::ShownClock> run_clock() const { return run_clock_.at(loop_.stamp_now()); }
  const dispatch::Reports& reports() const { return *reports_; }
  /// Why the ledger cannot be written, or "".
  const std::string& trouble() const { return output_.trouble(); }

 private:
  /// The status that was asked for, and is still to be answered.
  struct AskedStatus {
    loop::Instant at;
    bool decides;  // whether a report can go, or what became of one
  };
  /// Somebody who asked for the status.
  struct Asker {
    std::shared_ptr<intake::Responder> responder;
    loop::Instant until;  // then it is told what is known
  };

  void hear_time();
  /// Reports are written down by the clock for stamps, which nobody sets: rules compare their times.
  dispatch::Time time() const { return {loop_.now(), loop_.stamp_now()}; }
  void open_reports();
  void endpoint_turned();
  void take(const dispatch::Posted& posted, dispatch::ClientId client) noexcept;
  void poll();
  void pump() noexcept;
  bool is_free(const dispatch::Wish& wish, loop::Instant now);
  void send(const dispatch::Report& report);
  void send_next();
  void report_answered(const uplink::Outcome& outcome);
  void judge_report(const uplink::Outcome& outcome);
  void ask_status(bool decides);
  void status_answered(const uplink::Outcome& outcome);
  void judge_status(const uplink::Outcome& outcome, loop::Instant asked);
  void answer_askers(const intake::Answer& answer);
  void watch_deadlines();
  void tell_askers(loop::Instant now);
  std::optional<loop::Instant> first_asker() const;
  bool may_ask_soon(loop::Instant now) const;
  std::optional<intake::Answer> known_status() const;
  void deadline_came();
  std::string why_no_status() const;
  static intake::Answer no_status(const std::string& why);
  intake::Answer known_or(intake::Answer failure) const;

  loop::Loop& loop_;
  ledger::Ledger& ledger_;
  const settings::Settings& settings_;
  Record& record_;
  ReportOutput output_;
  Clocks& clocks_;
  std::unique_ptr<dispatch::Reports> reports_;  // never null
  Channel channel_;
  ScoringPace pace_;
  loop::Source wake_, poll_, deadline_;

  std::deque<Asker> askers_;
  bool poll_due_ = false;  // Adit itself wants to know the status

  std::optional<icd::RunStatus> run_;
  alarms::RunClock run_clock_;
  KnownStatus known_status_;
  std::optional<AskedStatus> asked_status_;
  bool stopping_ = false;
};

}  // namespace adit::forward
