#pragma once

#include <cstdint>
#include <expected>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "dispatch/output.hpp"
#include "dispatch/run_changes.hpp"

namespace adit::dispatch {

struct HttpAnswer {
  int status = 0;
  std::string content_type;
  std::string body;
  bool is_unprocessed = false;  // event_of()
};

/// Next requests to the Command Post.
struct NextRequests {
  bool report = false;  // a queued report may be sent
  /// When to request the run's status. nullopt: not needed.
  std::optional<Instant> status;
  bool in_doubt = false;  // the status decides a doubt
};

/// Why a request for the status has none.
enum class NoStatus : std::uint8_t {
  NoAnswer,  // the Command Post was not reached
  Page,      // it is a web page with 2xx: the address is another server's
  Other,     // an answer without a usable status, or a doubt
};

struct PostedReport {
  icd::ArtifactReport report;
  std::string sender;     // client's address
  bool resubmit = false;  // a new report, even if it repeats a finished one
  bool can_be_undone = false;
};

/// The rules of all reports (promise 1), without I/O or clock. Output writes each step before its effects.
///
/// At most one request is in flight. After choose() returns a report, or accept() true, call exactly one of
/// on_answered(), on_never_sent() and on_lost() before the next request. After a request for the status, call
/// on_status() or on_status_failed().
class Reports {
 public:
  using Outcome = std::expected<std::int64_t, std::string>;  // a report's number, or why not

  /// `output` outlives this.
  Reports(const ReportRules& rules, Output& output);

  /// Starts from the ledger. If `post` is another one than before, its last run or a new one becomes present.
  void open(std::vector<Report> all, std::vector<Run> runs, Time time, const std::string& post = "");
  /// Starts from `before`, which has no report in flight: with its steps that the ledger lacks, because the
  /// disk failed, and with its clients and their deadlines.
  void adopt(Reports& before, Time time, const std::string& post);
  /// The settings name `post`. Call open() after the request in flight. Reports that arrive before that
  /// belong to the run at `post`, also after a restart.
  void prepare_move(const std::string& post, Time time) { changes_.prepare_move(post, time); }
  /// Waiting clients keep their deadlines.
  void set_rules(const ReportRules& rules) { rules_ = rules; }
  /// `spacing`: the time between requests by the Command Post's limit.
  void set_spacing(Instant::duration spacing) { account_.set_spacing(spacing); }
  /// Stamps that were read from disk may be from before the step.
  void on_clock_step(const ClockStep& step) { account_.on_clock_step(step); }

  /// Accepts a report. Output answers the client now or later. `may_send`: no request is in flight and the
  /// rate limit allows one. True: the report is on disk as sending(); send it.
  bool accept(const PostedReport& posted, ClientId client, bool may_send, Time time);

  NextRequests next_requests(Time time) const;
  /// The first queued report that may be sent, on disk as sending(). Null: none, or the write failed.
  const Report* choose(Time time);
  ReportEvent on_answered(const HttpAnswer& answer, Time time);
  void on_never_sent(const std::string& why, Time time) { on_ended(ReportEvent::NeverLeft, why, time); }
  void on_lost(const std::string& why, Time time) { on_ended(ReportEvent::Lost, why, time); }
  /// `asked`: time of the request.
  void on_status(const icd::RunStatus& status, Instant asked, Time time);
  void on_status_failed(NoStatus why, Time time);

  /// Answers clients whose time is up, repeats failed writes. Call at next_deadline() at the latest.
  void tick(Time time);
  std::optional<Instant> next_deadline() const;
  /// aditd stops: answers all clients. Without `all`, clients of the report in flight wait on.
  void dismiss(bool all) { clients_.dismiss(all); }

  /// The operator's actions return the changed report's number, or why they failed.
  Outcome send(std::int64_t number, Time time);
  Outcome hold(std::int64_t number, Time time);
  Outcome withdraw(std::int64_t number, Time time);
  Outcome settle(std::int64_t number, Time time);
  /// Withdraws a held report and sends `to` in its place, as a new report. Its clients, and repeats of it,
  /// get the new report's answer. Returns the new report's number.
  Outcome correct(std::int64_t number, const icd::ArtifactReport& to, Time time);
  /// Sends a copy as a new report. Returns its number, or that of an unfinished copy.
  Outcome resubmit(std::int64_t number, Time time);
  /// Returns the new run's number.
  std::int64_t declare_new_run(Time time) { return changes_.declare(time); }

  std::optional<std::int64_t> awaited_report(ClientId client) const {
    return clients_.awaited_report(client);
  }
  const ReportBook& book() const { return book_; }
  const Run& run() const { return account_.run(); }
  const Runs& runs() const { return account_.runs(); }
  /// The run of a report that is posted now: run(), or the run of prepare_move().
  const Run& expected_run() const { return account_.expected_run(); }
  /// Queued reports for the Command Post of the present run, oldest first.
  std::vector<std::int64_t> waiting_here() const { return account_.waiting_here(); }
  /// Numbers of queued reports for other Command Posts than the settings name, by address.
  std::map<std::string, std::size_t> waiting_elsewhere() const;
  const Report* sending() const { return book_.sending(); }
  /// Lost reports. New reports are held until the operator settles them.
  std::vector<const Report*> lost_reports() const { return review_.lost_reports(); }
  /// The status expected now. nullopt: uncertain, or the counts prove no report.
  std::optional<icd::RunStatus> expected_status(Instant now) const { return account_.expected_status(now); }
  /// When a held report is sent, in seconds since 1970. nullopt: the operator decides, or it is not held.
  std::optional<double> sends_at(const Report& report) const { return review_.sends_at(report.number); }
  /// True if the report is in doubt and Adit still asks about it.
  bool is_asking(const Report& report) const { return doubts_.is_asking(report); }

 private:
  void begin(std::vector<Run> runs, Time time, const std::string& post);
  void follow(std::int64_t number, ReportAction action, Time time);
  bool is_fresh(Instant now) const { return &expected_run() == &run() && account_.is_fresh(now); }
  bool accept_new(Report report, const Hold& hold, ClientId client, bool may_send, Time time);
  std::int64_t add(Report report, const Hold& hold, bool now, Time time, std::span<const Report> before = {});
  bool end_undo(std::int64_t number, const std::string& note, Time time);
  void doubt_in_flight(Time time);
  std::optional<std::int64_t> next(Instant now) const;
  bool can_send(const Report& report, Instant now) const;
  bool can_go_first(const Report& report, Instant now) const;
  bool check(std::int64_t number, Time time);
  void prepare(Report& report, Time time);
  const Report* find_other_report(const icd::ReportReply& reply) const;
  void on_recorded(const ReportBook::Edit& keep, const icd::ReportReply& reply, Time time);
  void on_ended(ReportEvent event, const std::string& note, Time time,
                const ReportBook::Edit& edit = nullptr);

  ReportRules rules_;
  Output& output_;
  ReportBook book_;
  RunAccount account_;
  ReportReview review_;
  Doubts doubts_;
  WaitingClients clients_;
  RunChanges changes_;
  std::int64_t last_sending_ = 0;   // Report::sending of the last sending
  bool barred_ = false;             // no report is sent before a status arrives
  bool is_page_ = false;            // the status is a web page: only ordered_ reports are sent
  std::set<std::int64_t> ordered_;  // the operator sends them, even to a server whose status is a web page
};

/// A sentence with the counts of unfinished reports, for settings that name the Command Post at `post`.
std::string describe_command_post_change(const Reports& reports, const std::string& post);

}  // namespace adit::dispatch
