#include "rehearsal/robots/desk.hpp"

#include <cstdio>
#include <utility>

#include "rehearsal/robots/http.hpp"

namespace adit::robots {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds kStatusEvery{5};
constexpr std::chrono::milliseconds kAfter429{1200};  // the Command Post takes about one a second (ICD 5)

std::string signed_number(int number) {
  return std::string(number < 0 ? "" : "+").append(std::to_string(number));
}

}  // namespace

OperatorDesk::OperatorDesk(Post post, const Style& style, Tally& tally,
                           std::function<void(const std::string&)> say)
    : post_(std::move(post)), style_(style), tally_(tally), say_(std::move(say)) {}

bool OperatorDesk::is_news(std::size_t artifact) {
  const std::scoped_lock lock(mutex_);
  return known_.insert(artifact).second;
}

void OperatorDesk::submit(Finding finding) {
  const std::scoped_lock lock(mutex_);
  waiting_.push_back(std::move(finding));
  changed_.notify_all();
}

void OperatorDesk::work(const std::stop_token& finish, const std::stop_token& abort) {
  Clock::time_point next_status = Clock::now();
  while (!finish.stop_requested()) {
    if (Clock::now() >= next_status) {
      ask_status(abort);
      next_status = Clock::now() + kStatusEvery;
    }
    Finding finding;
    {
      std::unique_lock lock(mutex_);
      if (!changed_.wait_until(lock, finish, next_status, [&] { return !waiting_.empty(); })) continue;
      finding = std::move(waiting_.front());
      waiting_.pop_front();
    }
    report(finding, finish, abort);
  }
}

void OperatorDesk::sleep(std::chrono::milliseconds time, const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  (void)changed_.wait_for(lock, stop, time, [] { return false; });
}

void OperatorDesk::ask_status(const std::stop_token& abort) {
  Client client(post_, "operator", style_, tally_, abort);
  const auto reply = client.send(StatusQuery{});
  if (!reply || reply->status != 200) return;  // counted by the client
  const auto status = parse_status_answer(reply->body);
  if (!status) tally_.failed("GET /api/status: " + status.error());
}

void OperatorDesk::tell(const Finding& finding, const std::string& outcome) const {
  const Vector3& at = finding.report.position;
  std::array<char, 80> place{};
  (void)std::snprintf(place.data(), place.size(), " at (%.2f, %.2f, %.2f): ", at.x, at.y, at.z);
  say_(finding.robot + " reports " + finding.report.type + place.data() + outcome);
}

/// A report that was refused with 429 was not recorded and goes again; one whose answer was lost may have
/// been, and does not: that would cost one of the scarce reports.
void OperatorDesk::report(const Finding& finding, const std::stop_token& finish,
                          const std::stop_token& abort) {
  Client client(post_, finding.robot, *finding.style, tally_, abort);
  while (!finish.stop_requested()) {
    const auto reply = client.send(finding.report);
    if (!reply) {
      tally_.report_came_to("no answer");
      return tell(finding, "no answer");
    }
    if (reply->status == 429) {
      sleep(kAfter429, finish);
      continue;
    }
    if (reply->status != 200 && reply->status != 201) {
      tally_.report_came_to("rejected with " + std::to_string(reply->status));
      return tell(finding, std::to_string(reply->status) + " " + sentence_of(reply->body));
    }
    const auto answer = parse_report_answer(reply->body);
    if (!answer) {
      tally_.failed("POST /api/artifact_reports: " + answer.error());
      return tell(finding, answer.error());
    }
    const std::string outcome = answer->report_status + " " + signed_number(answer->score_change);
    tally_.report_came_to(outcome);
    return tell(finding, std::to_string(reply->status) + " " + outcome);
  }
}

}  // namespace adit::robots
