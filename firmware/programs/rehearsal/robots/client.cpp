#include "rehearsal/robots/client.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "rehearsal/robots/http.hpp"

namespace adit::robots {
namespace {

using Counts = std::map<std::string, std::uint64_t>;

/// A hostile server may send a new sentence each time.
void add(Counts& counts, const std::string& what) {
  constexpr std::size_t kMost = 50;
  const bool room = counts.contains(what) || counts.size() < kMost;
  ++counts[room ? what : "(others)"];
}

void list(std::string& text, std::string_view title, const Counts& counts) {
  for (const auto& [what, times] : counts) {
    text += std::string(title) + " " + what + " (" + std::to_string(times) + " times)\n";
  }
}

}  // namespace

void Tally::count(Kind kind, Fate fate, const std::string& why) {
  const std::scoped_lock lock(mutex_);
  ++rows_[static_cast<std::size_t>(kind)][static_cast<std::size_t>(fate)];
  const std::string what = std::string(name_of(kind)) + ": " + why;
  if (fate == Fate::Rejected) add(rejections_, what);
  if (fate == Fate::Unanswered) add(silences_, what);
}

void Tally::report_came_to(const std::string& outcome) {
  const std::scoped_lock lock(mutex_);
  add(reports_, outcome);
}

void Tally::failed(const std::string& what) {
  const std::scoped_lock lock(mutex_);
  add(failures_, what);
}

std::uint64_t Tally::accepted_of(Kind kind) const {
  const std::scoped_lock lock(mutex_);
  return times(rows_[static_cast<std::size_t>(kind)], Fate::Accepted);
}

bool Tally::clean() const {
  const std::scoped_lock lock(mutex_);
  return failures_.empty() &&
         std::ranges::all_of(rows_, [](const Row& row) { return times(row, Fate::Rejected) == 0; });
}

std::string Tally::line() const {
  const std::scoped_lock lock(mutex_);
  std::string text;
  for (std::size_t i = 0; i < kKinds; ++i) {
    if (times(rows_[i], Fate::Posted) == 0) continue;
    text += (text.empty() ? "" : ", ") + std::string(name_of(static_cast<Kind>(i))) + " " +
            std::to_string(times(rows_[i], Fate::Accepted)) + "/" +
            std::to_string(times(rows_[i], Fate::Posted));
  }
  return text;
}

std::string Tally::summary() const {
  const std::scoped_lock lock(mutex_);
  std::string text = "kind         posted  accepted       429  rejected  no answer\n";
  for (std::size_t i = 0; i < kKinds; ++i) {
    if (times(rows_[i], Fate::Posted) == 0) continue;
    std::array<char, 32> cell{};
    (void)std::snprintf(cell.data(), cell.size(), "%-9s", std::string(name_of(static_cast<Kind>(i))).c_str());
    text += cell.data();
    for (std::size_t fate = 0; fate < kFates; ++fate) {
      const int width = fate + 1 < kFates ? 9 : 10;
      (void)std::snprintf(cell.data(), cell.size(), " %*llu", width,
                          static_cast<unsigned long long>(rows_[i][fate]));
      text += cell.data();
    }
    text += '\n';
  }
  list(text, "rejected:", rejections_);
  list(text, "no answer:", silences_);
  list(text, "reports:", reports_);
  list(text, "failed:", failures_);
  return text;
}

namespace {

constexpr std::chrono::seconds kReportPatience{30};
constexpr std::chrono::seconds kPatience{5};

bool is_success(Kind kind, int status) {
  return status == 200 || (kind == Kind::Report && status == 201);
}

/// Whether Access-Control-Allow-Headers names `header`. By the Fetch standard "*" does not stand for
/// Authorization, so it has to be named.
bool allows(std::string headers, const std::string& header) {
  std::ranges::transform(headers, headers.begin(),
                         [](char c) { return c >= 'A' && c <= 'Z' ? char(c + 32) : c; });
  return headers.find(header) != std::string::npos;
}

}  // namespace

Client::Client(const Post& post, std::string robot, const Style& style, Tally& tally, std::stop_token stop)
    : encoder_(std::move(robot), style, post.token),
      style_(style),
      tally_(tally),
      scoring_(post.scoring),
      stop_(std::move(stop)),
      mapping_(post.mapping, stop_) {}

std::optional<HttpReply> Client::send(const Message& message) {
  const Kind kind = kind_of(message);
  const HttpRequest request = encoder_.encode(message);
  if (kind == Kind::Report || kind == Kind::Status) {
    // As teams' scripts do: a fresh connection for each call, so that no report is swallowed by an old one.
    Connection scoring(scoring_, stop_);
    return may_send(scoring, request) ? exchange(scoring, kind, request) : std::nullopt;
  }
  return may_send(mapping_, request) ? exchange(mapping_, kind, request) : std::nullopt;
}

std::optional<HttpReply> Client::exchange(Connection& connection, Kind kind, const HttpRequest& request) {
  const bool report = kind == Kind::Report;
  tally_.count(kind, Fate::Posted);
  auto reply = connection.exchange(request, report ? kReportPatience : kPatience, report);
  if (!reply) {
    tally_.count(kind, Fate::Unanswered, reply.error());
    return std::nullopt;
  }
  const Fate fate = is_success(kind, reply->status) ? Fate::Accepted
                    : reply->status == 429          ? Fate::Throttled
                                                    : Fate::Rejected;
  tally_.count(kind, fate, std::to_string(reply->status) + " " + sentence_of(reply->body));
  return *std::move(reply);
}

bool Client::may_send(Connection& connection, const HttpRequest& request) {
  if (!style_.browser) return true;
  tally_.count(Kind::Preflight, Fate::Posted);
  const auto reply = connection.exchange(Encoder::preflight(request), kPatience);
  if (!reply) {
    tally_.count(Kind::Preflight, Fate::Unanswered, reply.error());
    return false;
  }
  const bool allowed = reply->status >= 200 && reply->status < 300 &&
                       (reply->allowed_origin == "*" || reply->allowed_origin == Encoder::kOrigin) &&
                       allows(reply->allowed_headers, "authorization");
  tally_.count(Kind::Preflight, allowed ? Fate::Accepted : Fate::Rejected,
               std::to_string(reply->status) + " for " + request.method + " " + request.target);
  return allowed;
}

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds kStatusEvery{5};
constexpr std::chrono::milliseconds kAfter429{1200};  // the Command Post takes about one a second (ICD 5)

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

void OperatorDesk::ask_status(const std::stop_token& abort) {
  Client client(post_, "operator", style_, tally_, abort);
  const auto reply = client.send(StatusQuery{});
  if (!reply || reply->status != 200) return;  // counted by the client
  if (const auto status = check_status_answer(reply->body); !status)
    tally_.failed("GET /api/status: " + status.error());
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
      pause_until(Clock::now() + kAfter429, finish);
      continue;
    }
    if (reply->status != 200 && reply->status != 201) {
      tally_.report_came_to("rejected with " + std::to_string(reply->status));
      return tell(finding, std::to_string(reply->status) + " " + sentence_of(reply->body));
    }
    const auto outcome = parse_report_answer(reply->body);
    if (!outcome) {
      tally_.failed("POST /api/artifact_reports: " + outcome.error());
      return tell(finding, outcome.error());
    }
    tally_.report_came_to(*outcome);
    return tell(finding, std::to_string(reply->status) + " " + *outcome);
  }
}

}  // namespace adit::robots
