#pragma once

#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dispatch/reports.hpp"
#include "icd/sentence.hpp"

namespace adit::dispatch {

constexpr const char* kHere = "10.100.1.200:8000";
constexpr const char* kThere = "10.100.2.200:8000";

/// Keeps the ledger and each answer to a client in memory.
class FakeOutput final : public Output {
 public:
  struct Reply {
    int status = 0;
    std::string sentence;  // empty: the stored answer of the report
    std::string body;      // of the stored answer
    std::int64_t number = 0;
  };

  bool write(std::span<const Report> steps, const Run* last, Flush flush) override {
    if (full || writes_until_full == 0) return false;
    --writes_until_full;
    ++writes;
    last_flush = flush;
    for (const Report& report : steps) {
      ledger[report.number] = report;
      states[report.number].push_back(report.state);
    }
    if (last != nullptr) {
      run = *last;
      runs[last->number] = *last;
    }
    return true;
  }
  void answer_client(ClientId client, const ClientAnswer& answer, const Report& report) override {
    const bool own = !answer.sentence.empty();
    answers[client].push_back({.status = own ? static_cast<int>(answer.status) : report.status,
                               .sentence = answer.sentence,
                               .body = own ? "" : report.answer,
                               .number = answer.number});
  }

  bool full = false;
  std::int64_t writes_until_full = -1;  // negative: never
  std::int64_t writes = 0;
  Flush last_flush = Flush::Now;
  std::map<std::int64_t, Report> ledger;
  std::map<std::int64_t, std::vector<ReportState>> states;  // states in order of writing
  std::optional<Run> run;                                   // last written
  std::map<std::int64_t, Run> runs;
  std::map<ClientId, std::vector<Reply>> answers;
};

inline HttpAnswer recorded_answer(std::int64_t points = 0, const std::string& report_status = "scored",
                                  const std::string& run = "1", double run_clock = 0) {
  return {201, "application/json",
          icd::sentence("{\"run\": \"", run, "\", \"run_clock\": ", run_clock, ", \"report_status\": \"",
                        report_status, "\", \"score_change\": ", points, "}")};
}
inline HttpAnswer answer_of(int status) {
  return {status, "application/json", "\"the Command Post's words\""};
}

/// Reports in simulated time: at 100 s of a run, with 20 reports left and a fresh status.
class Scene {
 public:
  static constexpr double kEpoch = 1.7e9;  // simulated time 0, as a stamp

  explicit Scene(const ReportRules& rules = {}) : rules_(rules) {
    restart();
    receive_status(20, 0);
  }

  Reports& reports() { return *reports_; }
  const Reports& reports() const { return *reports_; }
  FakeOutput& output() { return output_; }
  Time time() const {
    return {Instant(std::chrono::milliseconds(static_cast<std::int64_t>(now_ * 1000))),
            kEpoch + now_ + clock_set_by_};
  }
  double now() const { return now_; }
  void wait(double seconds) {
    now_ += seconds;
    reports_->tick(time());
  }
  void set_box_clock_forward(double seconds) { clock_set_by_ += seconds; }
  /// Applied by the next restart.
  void step_clock(double seconds) {
    set_box_clock_forward(seconds);
    clock_step_ = {.to = time().stamp, .by = seconds};
  }

  /// Kills the process and starts it from the disk.
  void restart(const std::string& post = "10.100.1.200:8000") {
    reports_ = std::make_unique<Reports>(rules_, output_);
    reports_->on_clock_step(clock_step_);
    reports_->open(all_reports(), all_runs(), time(), post);
  }
  /// The settings name another Command Post; the process goes on.
  void move_to(const std::string& post) {
    auto next = std::make_unique<Reports>(rules_, output_);
    next->adopt(*reports_, time(), post);
    reports_ = std::move(next);
  }

  /// A client posts. The report may be sent at once if none is in flight.
  ClientId post(double x = 1, const std::string& type = "Drill", bool resubmit = false) {
    return post(x, type, resubmit, reports_->sending() == nullptr);
  }
  /// As post(), but the rate limit forbids sending.
  ClientId post_queued(double x = 1, const std::string& type = "Drill") {
    return post(x, type, false, false);
  }
  /// The operator posts; the report can be undone if the rules allow it.
  ClientId compose(double x = 1, bool resubmit = false) {
    return post({.report = {.type = "Drill", .position = {x, 0, 0}},
                 .sender = "operator",
                 .resubmit = resubmit,
                 .can_be_undone = true},
                reports_->sending() == nullptr);
  }
  ClientId post(const PostedReport& posted, bool may_send) {
    reports_->accept(posted, ++last_client_, may_send, time());
    return last_client_;
  }
  /// Returns the number of the sent report; 0: none.
  std::int64_t send_next() {
    if (!reports_->next_requests(time()).report) return 0;
    const Report* const chosen = reports_->choose(time());
    return chosen != nullptr ? chosen->number : 0;
  }
  void answer(const HttpAnswer& answer) { reports_->on_answered(answer, time()); }
  /// A client posts, and the Command Post records it in the run of that name.
  void record(double x, const std::string& run) {
    post(x);
    answer(recorded_answer(0, "scored", run));
  }
  void lose_answer() { reports_->on_lost("no answer", time()); }

  /// A status with the expected run clock.
  void receive_status(std::int64_t remaining, std::int64_t score) {
    receive_status(remaining, score, run_clock());
  }
  void receive_status(std::int64_t remaining, std::int64_t score, double clock) {
    reports_->on_status({score, clock, remaining, "adit"}, time().now, time());
  }
  double run_clock() const { return now_; }
  /// The same status each second.
  void repeat_status(double seconds, std::int64_t remaining, std::int64_t score) {
    for (double end = now_ + seconds; now_ < end;) {
      wait(1);
      receive_status(remaining, score);
    }
  }

  /// An administrative stop: a status each second with a standing run clock. The count decides nothing, and
  /// other reports are not blocked.
  void repeat_stop(int seconds, double clock = 101) {
    for (int i = 0; i < seconds; ++i) {
      wait(1);
      receive_status(20, 0, clock);
    }
  }

  const Report& report(std::int64_t number) const { return reports_->book().at(number); }
  ReportState state(std::int64_t number) const { return report(number).state; }
  /// Notes of the reports that the operator must decide.
  std::vector<std::string> undecided() const {
    std::vector<std::string> notes;
    for (const std::int64_t number : reports().book().open()) {
      const bool undecided = state(number) == ReportState::Held || state(number) == ReportState::InDoubt;
      if (undecided) notes.push_back(report(number).note);
    }
    return notes;
  }
  std::size_t count() const { return reports_->book().all().size(); }
  bool is_answered(ClientId client) const { return output_.answers.contains(client); }
  /// The last answer to the client; status 0: none.
  FakeOutput::Reply answer_to(ClientId client) const {
    const auto found = output_.answers.find(client);
    return found == output_.answers.end() ? FakeOutput::Reply{} : found->second.back();
  }

 private:
  std::vector<Report> all_reports() const {
    std::vector<Report> all;
    all.reserve(output_.ledger.size());
    for (const auto& [number, report] : output_.ledger) all.push_back(report);
    return all;
  }
  std::vector<Run> all_runs() const {
    std::vector<Run> runs;
    runs.reserve(output_.runs.size());
    for (const auto& [number, run] : output_.runs) runs.push_back(run);
    return runs;
  }

  ClientId post(double x, const std::string& type, bool resubmit, bool may_send) {
    return post({.report = {.type = type, .position = {x, 0, 0}}, .sender = "10.0.0.7", .resubmit = resubmit},
                may_send);
  }

  const ReportRules rules_;
  FakeOutput output_;
  std::unique_ptr<Reports> reports_;
  double now_ = 100;
  double clock_set_by_ = 0;
  ClockStep clock_step_;
  ClientId last_client_ = 0;
};

}  // namespace adit::dispatch
