#pragma once

#include <chrono>
#include <cstdint>
#include <expected>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "dispatch/inquiry.hpp"
#include "dispatch/output.hpp"
#include "dispatch/report_book.hpp"
#include "dispatch/run_account.hpp"
#include "dispatch/waiting_clients.hpp"

namespace adit::dispatch {

/// Reports that need the operator's release.
enum class Review : std::uint8_t { Off, Duplicates, All };

struct ReportRules {
  std::chrono::milliseconds answer_within{20000};  // then a client gets the state instead of the answer
  Review review = Review::Off;
  double near_metres = 5;  // same type and so near: a near duplicate
  InquiryPolicy policy;
  std::size_t most_waiting = 1000;
  std::chrono::seconds undo{0};  // how long a report waits for an undo, if Posted::can_be_undone
};

struct Posted {
  icd::ArtifactReport report;
  std::string sender;     // client's address
  bool resubmit = false;  // a new report, even if it repeats a finished one
  bool can_be_undone = false;
};

struct HttpAnswer {
  int status = 0;
  std::string content_type;
  std::string body;
};

/// Next requests to the Command Post.
struct Wish {
  bool report = false;  // a queued report may be sent
  /// When to request the run's status. nullopt: not needed.
  std::optional<std::chrono::steady_clock::time_point> status;
  bool in_doubt = false;  // the status decides a doubt
};

/// The rules of all reports (promise 1), without I/O or clock. Output writes each step to disk before the
/// step has effects.
///
/// At most one request is in flight. After choose() returns a report, or take() true, call exactly one of
/// answered(), never_left() and lost() before the next request. After a request for the status, call
/// status_heard() or status_failed().
class Reports {
 public:
  using Instant = std::chrono::steady_clock::time_point;
  using Outcome = std::expected<std::int64_t, std::string>;  // a report's number, or why not

  static constexpr std::chrono::seconds kYoung{10};  // a posted report is for the present run
  static constexpr std::int64_t kMostTries = 5;      // losses until a report is held

  /// `output` outlives this.
  Reports(const ReportRules& rules, Output& output);

  /// Starts from the ledger. If `post` is another Command Post than before, its last run or a new one becomes
  /// the present run.
  void open(std::vector<Report> all, std::vector<Run> runs, Time time, const std::string& post = "");

  /// The same, and takes over the clients of `before` with their deadlines. Requires that `before` has no
  /// report in flight.
  void open(std::vector<Report> all, std::vector<Run> runs, Time time, const std::string& post,
            Reports& before);
  /// The settings name `post`. Call open() after the request in flight. Reports that arrive before that
  /// belong to the run at `post`, also after a restart.
  void will_move(const std::string& post, Time time);
  /// Waiting clients keep their deadlines.
  void go_by(const ReportRules& rules) { rules_ = rules; }
  /// `spacing`: the time between requests by the Command Post's limit.
  void paced(Instant::duration spacing) { account_.paced(spacing); }
  /// Stamps that were read from disk may be from before the step.
  void clock_stepped(const ClockStep& step) { account_.clock_stepped(step); }

  /// Accepts a report. Output answers the client now or later. `may_send`: no request is in flight and the
  /// rate limit allows one. True: the report is on disk as sending(); send it.
  bool take(const Posted& posted, ClientId client, bool may_send, Time time);

  Wish wish(Time time) const;
  /// The first queued report that may be sent, on disk as sending(). Null: no such report, or the write
  /// failed.
  const Report* choose(Time time);
  ReportEvent answered(const HttpAnswer& answer, Time time);
  void never_left(const std::string& why, Time time);
  void lost(const std::string& why, Time time);
  /// `asked`: time of the request.
  void status_heard(const icd::RunStatus& status, Instant asked, Time time);
  /// `reached`: the Command Post answered, without a usable status.
  void status_failed(bool reached, Time time);

  /// Answers clients whose time is up, repeats failed writes. Call at next_deadline() at the latest.
  void tick(Time time);
  std::optional<Instant> next_deadline() const;
  /// aditd stops: answers all clients. Without `all`, clients of the report in flight wait on.
  void dismiss(bool all);

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
  std::int64_t declare_new_run(Time time);

  /// The report that a client waits for. nullopt: the client does not wait.
  std::optional<std::int64_t> awaited_by(ClientId client) const { return clients_.awaited_by(client); }
  const ReportBook& book() const { return book_; }
  const Run& run() const { return account_.run(); }
  const Runs& runs() const { return account_.runs(); }
  /// The run of a report that is posted now: run(), or the run of will_move().
  const Run& meant_run() const { return will_be_ != 0 ? *account_.runs().find(will_be_) : run(); }
  /// Queued reports for the Command Post of the present run, oldest first.
  std::vector<std::int64_t> waiting_here() const;
  /// Numbers of queued reports for other Command Posts than the settings name, by address.
  std::map<std::string, std::size_t> waiting_elsewhere() const;
  const Report* sending() const { return sending_ ? &book_.at(*sending_) : nullptr; }
  /// The status expected now. nullopt: uncertain, or the counts prove no report.
  std::optional<icd::RunStatus> expected(Instant now) const { return account_.expected(now); }
  /// When a held report is sent unless the operator withdraws it, in seconds since 1970. nullopt: the
  /// operator decides, or it is not held.
  std::optional<double> sends_at(const Report& report) const;
  /// True if the report is in doubt and Adit still asks about it.
  bool is_asking(const Report& report) const;

 private:
  // Clients.
  void tell_how_it_stands(ClientId client, const Report& report);
  void join(ClientId client, const Report& earlier, Time time);
  void hand_clients_over(std::int64_t number, const Report& earlier);

  /// The time for an undo of a held report. It is in no file, so that a restart leaves the report held.
  struct Undo {
    Instant until;
    double stamp;  // the same, in seconds since 1970
  };

  // Accepting and choosing.
  bool is_of_run(const Report& report) const;
  bool is_fresh(Instant now) const { return will_be_ == 0 && account_.is_fresh(now); }
  std::vector<std::int64_t> waiting_at(const std::string& post) const;
  std::vector<const Report*> same_in_run(const icd::ArtifactReport& report) const;
  const Report* earlier(const Report& report) const;
  const Report* twin(const Report& report) const;
  /// Why the operator must release a report. Empty: no reason.
  struct Hold {
    std::string why;
    std::int64_t same_as = 0;  // the report that it may repeat: held until the run is certain
    bool for_undo = false;     // held for ReportRules::undo only
  };
  Hold reason_to_hold(const Report& report) const;
  Hold maybe_repeat(const Report& report) const;
  bool check(std::int64_t number, Time time);
  bool is_young(const Report& report, Instant now) const;
  bool may_go(const Report& report, Instant now) const;
  std::optional<std::int64_t> next(Instant now) const;
  void recorded(const ReportBook::Edit& keep, const icd::ReportReply& reply, Time time);
  const Report* told_of_another(const icd::ReportReply& reply) const;
  const Report& original_of(const Report& report) const;
  Hold hold_for_undo() const;
  bool end_undo(std::int64_t number, const std::string& note, Time time);
  std::int64_t add(Report report, const Hold& hold, bool now, Time time, std::span<const Report> before = {});
  bool take_new(Report report, const Hold& hold, ClientId client, bool may_send, Time time);
  void prepare(Report& report, Time time);
  void enter_run(Report& report) const;
  bool step(std::int64_t number, ReportEvent event, const std::string& note, Time time,
            const ReportBook::Edit& edit = nullptr);
  bool take_steps(std::span<const ReportBook::Step> steps, Time time);
  void follow(std::int64_t number, ReportAction action, Time time);
  void ended(ReportEvent event, const std::string& note, Time time, const ReportBook::Edit& edit = nullptr);

  // Doubts.
  void doubt_began(Instant now);
  void inquire(const icd::RunStatus& status, Instant asked, Time time);
  SentSince sent_since(const Report& doubt) const;
  void settle(const std::vector<const Report*>& doubts, const Evidence& evidence, Time time);
  ReportBook::Step after_loss(const Report& doubt, const Evidence& evidence) const;
  void send_again(const std::vector<const Report*>& doubts, const Evidence& evidence, Time time);
  void explain(const std::vector<const Report*>& doubts, const std::string& why, Time time);
  bool blur_doubts(std::int64_t decided, Time time);
  void ask_for_others(Time time);

  // Runs.
  void change_post(const std::string& post, Time time);
  void meet(const AnotherRun& another, const icd::RunStatus& status, Time time);
  void meet(const icd::ReportReply& reply, Time time);
  std::vector<Report> steps_into(std::int64_t next, const std::string& why, Time time);
  std::vector<Report> answered_since_status(std::int64_t next) const;
  bool is_unclaimed(const Report& report) const;
  void claim(const std::string& name, Time time);
  void begin_run(const std::string& why, std::int64_t may_be, const std::optional<icd::RunStatus>& status,
                 Time time);
  void take_up_run(const Run& known, const std::string& why, Time time);
  void return_to(const Run& known, Time time);
  void clear_held(Time time);
  bool anything_was_sent_here() const;
  const Report* sent_elsewhere(const Report& report, const std::function<bool(const Run&)>& counts) const;
  const Report* unclaimed_same(const Report& report) const;
  const Report* same_in_maybe(const Report& report) const;
  const Report* sent_to_another_post(const Report& report) const;

  ReportRules rules_;
  ReportBook book_;
  RunAccount account_;
  WaitingClients clients_;
  std::map<std::int64_t, Instant> taken_at_;  // last POST of each report, for kYoung
  std::set<std::int64_t> unchecked_;          // not compared yet, because the run was unknown
  std::map<std::int64_t, Undo> undo_;         // held reports that are sent unless the operator undoes them
  std::optional<std::int64_t> sending_;
  std::int64_t will_be_ = 0;       // the run of will_move(), or 0
  std::int64_t last_sending_ = 0;  // Report::sending of the last sending
  std::optional<Inquiry> inquiry_;
  bool barred_ = false;    // no report is sent before a status arrives
  bool stopping_ = false;  // for the sentences to clients
  Output& output_;
};

}  // namespace adit::dispatch
