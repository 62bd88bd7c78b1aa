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

/// Which reports the operator has to release before they are sent.
enum class Review : std::uint8_t { Off, Duplicates, All };

struct ReportRules {
  std::chrono::milliseconds answer_within{20000};  // a client that waits longer is told how its report stands
  Review review = Review::Off;
  double near_metres = 5;  // a report of the same type within this distance is a near duplicate
  Patience patience;
  std::size_t most_waiting = 1000;
};

/// What a client posts.
struct Posted {
  icd::ArtifactReport report;
  std::string sender;     // its address
  bool resubmit = false;  // as a new report, even if it is the same as one that is finished
};

/// A whole answer of the Command Post's.
struct HttpAnswer {
  int status = 0;
  std::string content_type;
  std::string body;
};

/// What is to be asked of the Command Post next.
struct Wish {
  bool report = false;  // the first of those that wait may be sent
  /// From when on the run's status is needed; nothing: it is not needed.
  std::optional<std::chrono::steady_clock::time_point> status;
  bool in_doubt = false;  // it decides what became of a report
};

/// The life of all reports, with all its rules (promise 1): no I/O and no clock. Output puts each step on
/// disk before anything follows from it.
///
/// One request is under way at a time: choose(), or a take() that gives true, is followed by exactly one of
/// answered(), never_left() and lost() before anything else is sent or asked for; asking for the status, by
/// status_heard() or status_failed().
class Reports {
 public:
  using Instant = std::chrono::steady_clock::time_point;
  using Outcome = std::expected<std::int64_t, std::string>;  // a report's number, or why not

  static constexpr std::chrono::seconds kYoung{10};  // how long a report is surely meant for the present run
  static constexpr std::int64_t kMostTries = 5;      // sent so often and never recorded, it is held

  /// `output` outlives this.
  Reports(const ReportRules& rules, Output& output);

  /// Begins with what the ledger holds. `post`: the Command Post's address. If it is another than before, the
  /// run is another, too: the last one there, if there was one, or else a new one.
  void open(std::vector<Report> all, std::vector<Run> runs, Time time, const std::string& post = "");

  /// The same, taking over the clients of `before`, which wait no longer than they would have. Requires that
  /// `before` has nothing under way.
  void open(std::vector<Report> all, std::vector<Run> runs, Time time, const std::string& post,
            Reports& before);
  /// The settings now name `post`; open() follows once the request under way has ended. A report that comes
  /// meanwhile is meant for the run there, also after a restart.
  void will_move(const std::string& post, Time time);
  /// The rules from now on. A client that waits already keeps its deadline.
  void go_by(const ReportRules& rules) { rules_ = rules; }
  /// From one request to the next, as the Command Post's limit has it.
  void paced(Instant::duration spacing) { account_.paced(spacing); }
  /// What is read was written down before it, or after.
  void leapt(const Leap& leap) { account_.leapt(leap); }

  /// A client posts a report; it is told by Output, at once or later. `may_send`: nothing is under way and
  /// the rate allows it. True: it is on disk as sending(): send it.
  bool take(const Posted& posted, ClientId client, bool may_send, Time time);

  Wish wish(Time time) const;
  /// The first of those that wait, on disk as sending(). Nothing: none may go, or the disk refuses.
  const Report* choose(Time time);
  /// Gives what the answer means.
  ReportEvent answered(const HttpAnswer& answer, Time time);
  void never_left(const std::string& why, Time time);
  void lost(const std::string& why, Time time);
  /// `asked`: when it was asked for.
  void status_heard(const icd::RunStatus& status, Instant asked, Time time);
  /// `reached`: the Command Post answered, but nothing that helps.
  void status_failed(bool reached, Time time);

  /// Tells clients whose time is up, and writes what could not be written. Called at next_deadline() at the
  /// latest, and now and then.
  void tick(Time time);
  std::optional<Instant> next_deadline() const { return clients_.next_deadline(); }
  /// The gateway stops: tells all clients but those whose report is under way; if `all`, those too.
  void dismiss(bool all);

  /// The operator's actions. Each gives the number of the report that it moved, or a sentence why not.
  Outcome send(std::int64_t number, Time time);
  Outcome hold(std::int64_t number, Time time);
  Outcome withdraw(std::int64_t number, Time time);
  Outcome settle(std::int64_t number, Time time);
  /// Sends the same as a new report.
  Outcome resubmit(std::int64_t number, Time time);
  /// The operator says that a new run begins. Gives its number.
  std::int64_t declare_new_run(Time time);

  /// The report whose answer a client waits for; nothing: it was told at once, or waits no more.
  std::optional<std::int64_t> awaited_by(ClientId client) const { return clients_.awaited_by(client); }
  const ReportBook& book() const { return book_; }
  const Run& run() const { return account_.run(); }
  const Runs& runs() const { return account_.runs(); }
  /// The run that a report posted now is meant for: run(), or that of will_move().
  const Run& meant_run() const { return will_be_ != 0 ? *account_.runs().find(will_be_) : run(); }
  /// Those that wait for the Command Post that the settings name, oldest first.
  std::vector<std::int64_t> waiting_here() const;
  /// How many wait for each Command Post that the settings do not name.
  std::map<std::string, std::size_t> waiting_elsewhere() const;
  const Report* sending() const { return sending_ ? &book_.at(*sending_) : nullptr; }
  /// What /api/status would answer now; nothing: it is not known for certain, or proves nothing.
  std::optional<icd::RunStatus> expected(Instant now) const { return account_.expected(now); }
  /// Whether it is in doubt and Adit can find out by itself.
  bool is_asking(const Report& report) const;

 private:
  // Clients.
  void tell_how_it_stands(ClientId client, const Report& report);
  void join(ClientId client, const Report& earlier, Time time);
  void hand_clients_over(std::int64_t number, const Report& earlier);

  // Taking and choosing.
  bool is_of_run(const Report& report) const;
  bool is_fresh(Instant now) const { return will_be_ == 0 && account_.is_fresh(now); }
  std::vector<std::int64_t> waiting_at(const std::string& post) const;
  std::vector<const Report*> same_in_run(const icd::ArtifactReport& report) const;
  const Report* earlier(const Report& report) const;
  const Report* twin(const Report& report) const;
  /// Why the operator has to release it first; "": he has not.
  struct Hold {
    std::string why;
    std::int64_t same_as = 0;  // it may be the same as this one: held until the run is known for certain
  };
  Hold reason_to_hold(const Report& report) const;
  Hold maybe_repeat(const Report& report) const;
  bool check(std::int64_t number, Time time);
  bool is_young(const Report& report, Instant now) const;
  bool may_go(const Report& report, Instant now) const;
  std::optional<std::int64_t> next(Instant now) const;
  void recorded(const ReportBook::Edit& keep, const icd::ReportReply& reply, Time time);
  const Report* told_of_another(const icd::ReportReply& reply) const;
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
  bool blur_doubts(std::int64_t judged, Time time);
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
  std::map<std::int64_t, Instant> taken_at_;  // when somebody last posted it, in this program's life
  std::set<std::int64_t> unchecked_;          // not yet compared with earlier ones: the run was not known
  std::optional<std::int64_t> sending_;
  std::int64_t will_be_ = 0;       // the run that will_move() leads to; 0: none
  std::int64_t last_sending_ = 0;  // Report::sending of the last one sent
  std::optional<Inquiry> inquiry_;
  bool barred_ = false;    // nothing is sent before a status is answered
  bool stopping_ = false;  // for what clients are told
  Output& output_;
};

}  // namespace adit::dispatch
