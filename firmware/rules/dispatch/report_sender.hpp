#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>

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

/// Chooses the next report to send, and decides what its answer means.
class ReportSender {
 public:
  /// All outlive this.
  ReportSender(ReportBook& book, RunAccount& account, ReportReview& review, const Doubts& doubts,
               WaitingClients& clients, RunChanges& changes)
      : book_(book),
        account_(account),
        review_(review),
        doubts_(doubts),
        clients_(clients),
        changes_(changes) {}

  /// Call after ReportBook::open(): puts reports that were in flight at the end of the last process into
  /// doubt.
  void open(Time time);

  NextRequests next_requests(Time time) const;
  /// Reports::choose().
  const Report* choose(Time time);
  /// True if a report that is posted now may be sent at once.
  bool may_go_first(const Report& report, Instant now) const;
  /// Sets the fields that decide a doubt. Written before the bytes leave, they survive a crash.
  void prepare(Report& report, Time time);

  ReportEvent answered(const HttpAnswer& answer, Time time);
  /// Recorded, Rejected and the like come by answered().
  void ended(ReportEvent event, const std::string& note, Time time, const ReportBook::Edit& edit = nullptr);
  /// A status arrived: the token and the address are right.
  void status_heard() {
    barred_ = is_page_ = false;
    ordered_.clear();
  }
  void status_failed(NoStatus why) { is_page_ = why == NoStatus::Page; }
  /// The operator sends the report, even to a server whose status is a web page.
  void order(std::int64_t number) { ordered_.insert(number); }

 private:
  std::optional<std::int64_t> next(Instant now) const;
  bool may_go(const Report& report, Instant now) const;
  bool check(std::int64_t number, Time time);
  const Report* told_of_another(const icd::ReportReply& reply) const;
  void recorded(const ReportBook::Edit& keep, const icd::ReportReply& reply, Time time);

  ReportBook& book_;
  RunAccount& account_;
  ReportReview& review_;
  const Doubts& doubts_;
  WaitingClients& clients_;
  RunChanges& changes_;
  std::int64_t last_sending_ = 0;  // Report::sending of the last sending
  bool barred_ = false;            // no report is sent before a status arrives
  bool is_page_ = false;           // the status is a web page: only ordered_ reports are sent
  std::set<std::int64_t> ordered_;
};

}  // namespace adit::dispatch
