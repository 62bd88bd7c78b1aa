#include "rehearsal/robots/client.hpp"

#include <algorithm>
#include <cstdio>
#include <initializer_list>
#include <nlohmann/json.hpp>

#include "icd/sentence.hpp"
#include "icd/text.hpp"

namespace adit::robots {

namespace {

namespace asio = boost::asio;
namespace http = boost::beast::http;
using asio::ip::tcp;
using boost::system::error_code;
using Clock = std::chrono::steady_clock;

constexpr std::uint64_t kLargestReply = 1 << 20;

using Json = nlohmann::json;

Json parse(std::string_view body) {
  return Json::parse(body, nullptr, /*allow_exceptions=*/false);
}

using Names = std::initializer_list<const char*>;

/// A sentence about the first member that is not there, or of another type; "" if there is none.
std::string wrong_member(const Json& answer, Names numbers, Names texts) {
  if (!answer.is_object()) return "the answer is not a JSON object";
  for (const char* name : numbers) {
    if (!answer.contains(name) || !answer[name].is_number())
      return icd::sentence("the answer's '", name, "' is not a number");
  }
  for (const char* name : texts) {
    if (!answer.contains(name) || !answer[name].is_string())
      return icd::sentence("the answer's '", name, "' is not a string");
  }
  return "";
}

using Counts = std::map<std::string, std::uint64_t>;

/// A hostile server may send a new sentence each time.
void add(Counts& counts, const std::string& what) {
  count_bounded(counts, what, "(others)", 50);
}

void list(std::string& text, std::string_view title, const Counts& counts) {
  for (const auto& [what, times] : counts) text += icd::sentence(title, " ", what, " (", times, " times)\n");
}

constexpr std::chrono::seconds kReportPatience{30};
constexpr std::chrono::seconds kPatience{5};

bool is_success(MessageKind kind, int status) {
  return status == 200 || (kind == MessageKind::Report && status == 201);
}

/// Whether Access-Control-Allow-Headers names `header`. "*" does not cover Authorization (Fetch standard).
bool allows(std::string headers, std::string_view header) {
  std::ranges::transform(headers, headers.begin(), icd::lower);
  return headers.contains(header);
}

constexpr std::chrono::seconds kStatusEvery{5};
constexpr std::chrono::milliseconds kAfter429{1200};  // the Command Post takes about one a second (ICD 5)

}  // namespace

std::expected<Address, std::string> parse_url(std::string_view url) {
  const auto expected = [url](std::string_view why) {
    return wrong("expected http://ADDR:PORT, got '", url, "': ", why);
  };
  constexpr std::string_view kScheme = "http://";
  if (!url.starts_with(kScheme)) return expected("it does not start with http://");
  std::string_view rest = url.substr(kScheme.size());
  if (rest.ends_with('/')) rest.remove_suffix(1);
  auto address = read_address(rest, 1);
  if (!address) return expected(address.error());
  if (address->host == "localhost") address->host = "127.0.0.1";
  error_code bad;
  (void)asio::ip::make_address(address->host, bad);
  if (bad) return expected("the address is not an IP address");
  return address;
}

/// Ends Asio's asynchronous call at the deadline, or when it is to stop.
template <class Start>
error_code Connection::await(Start start) {
  std::optional<error_code> result;
  start([&result](error_code error, auto&&...) { result = error; });
  context_.restart();
  while (!result && !stop_.stop_requested() && Clock::now() < deadline_)
    context_.run_for(std::chrono::milliseconds(20));
  if (result) return *result;
  close();
  context_.run();
  return asio::error::timed_out;
}

void Connection::close() {
  error_code ignored;  // nothing to be done about a socket that does not close
  (void)socket_.close(ignored);
}

error_code Connection::transfer(http::request<http::string_body>& message,
                                http::response_parser<http::string_body>& parser) {
  error_code error, ignored;
  if (!socket_.is_open()) {
    buffer_.clear();
    const tcp::endpoint peer(asio::ip::make_address(server_.host), server_.port);
    error = await([&](auto done) { socket_.async_connect(peer, done); });
    if (!error) (void)socket_.set_option(tcp::no_delay(true), ignored);  // latency alone
  }
  if (!error) error = await([&](auto done) { http::async_write(socket_, message, done); });
  if (!error) error = await([&](auto done) { http::async_read(socket_, buffer_, parser, done); });
  if (error || !parser.keep_alive()) close();
  return error;
}

std::expected<HttpReply, std::string> Connection::exchange(const HttpRequest& request,
                                                           std::chrono::milliseconds time, bool send_once) {
  http::request<http::string_body> message{http::string_to_verb(request.method), request.target, 11};
  message.set(http::field::host, server_.text());
  for (const auto& [name, value] : request.fields) message.set(name, value);
  message.body() = request.body;
  message.prepare_payload();

  deadline_ = Clock::now() + time;
  while (true) {
    const bool kept = socket_.is_open();
    http::response_parser<http::string_body> parser;
    parser.body_limit(kLargestReply);
    const error_code error = transfer(message, parser);
    if (!error) {
      auto reply = parser.release();
      return HttpReply{.status = static_cast<int>(reply.result_int()),
                       .body = std::move(reply.body()),
                       .allowed_origin = std::string(reply[http::field::access_control_allow_origin]),
                       .allowed_headers = std::string(reply[http::field::access_control_allow_headers])};
    }
    const bool swallowed = kept && !parser.got_some() && error != asio::error::timed_out;
    if (!send_once && swallowed) continue;
    if (stop_.stop_requested()) return std::unexpected("stopped before the answer arrived");
    if (error == asio::error::timed_out)
      return std::unexpected(icd::sentence("no answer within ", time.count(), " ms"));
    if (error == http::error::end_of_stream) return std::unexpected("connection closed without an answer");
    return std::unexpected(error.message());
  }
}

std::string sentence_of(std::string_view body) {
  if (body.empty()) return "(empty body)";
  const Json json = parse(body);
  if (json.is_string()) return json.get<std::string>();
  if (json.is_object() && json.contains("detail") && json["detail"].is_string()) {
    return json["detail"].get<std::string>();
  }
  constexpr std::size_t kShown = 100;
  std::string line(icd::cut(body, '\n').substr(0, kShown));
  std::ranges::replace_if(line, [](char c) { return c < ' ' || c > '~'; }, '?');
  return (json.is_discarded() ? "not JSON: " : "") + line;
}

std::expected<std::string, std::string> parse_report_answer(std::string_view body) {
  const Json answer = parse(body);
  const std::string fault =
      wrong_member(answer, {"x", "y", "z", "run_clock", "score_change"}, {"type", "report_status"});
  if (!fault.empty()) return std::unexpected(fault);
  const int change = static_cast<int>(std::clamp(answer["score_change"].get<double>(), -99.0, 99.0));
  return answer["report_status"].get<std::string>() + (change < 0 ? " " : " +") + std::to_string(change);
}

std::expected<void, std::string> check_status_answer(std::string_view body) {
  const Json answer = parse(body);
  const char* const clock = answer.contains("run_clock") ? "run_clock" : "clock";  // ICD 5.1 has both
  const std::string fault = wrong_member(answer, {"score", "remaining_reports", clock}, {});
  if (!fault.empty()) return std::unexpected(fault);
  return {};
}

void Tally::count(MessageKind kind, Fate fate, const std::string& why) {
  const std::scoped_lock lock(mutex_);
  ++rows_[static_cast<std::size_t>(kind)][static_cast<std::size_t>(fate)];
  const std::string what = icd::sentence(name_of(kind), ": ", why);
  if (fate == Fate::Rejected) add(rejections_, what);
  if (fate == Fate::Unanswered) add(silences_, what);
}

void Tally::count_outcome(const std::string& outcome) {
  const std::scoped_lock lock(mutex_);
  add(reports_, outcome);
}

void Tally::count_failure(const std::string& what) {
  const std::scoped_lock lock(mutex_);
  add(failures_, what);
}

std::uint64_t Tally::accepted_of(MessageKind kind) const {
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
    text += icd::sentence(text.empty() ? "" : ", ", name_of(static_cast<MessageKind>(i)), " ",
                          times(rows_[i], Fate::Accepted), "/", times(rows_[i], Fate::Posted));
  }
  return text;
}

std::string Tally::summary() const {
  const std::scoped_lock lock(mutex_);
  std::string text = "kind         posted  accepted       429  rejected  no answer\n";
  for (std::size_t i = 0; i < kKinds; ++i) {
    if (times(rows_[i], Fate::Posted) == 0) continue;
    std::string row(name_of(static_cast<MessageKind>(i)));
    row.resize(9, ' ');
    for (std::size_t fate = 0; fate < kFates; ++fate)
      row += aligned_right(std::to_string(rows_[i][fate]), fate + 1 < kFates ? 10 : 11);
    text += row + '\n';
  }
  list(text, "rejected:", rejections_);
  list(text, "no answer:", silences_);
  list(text, "reports:", reports_);
  list(text, "failed:", failures_);
  return text;
}

Client::Client(const Post& post, std::string robot, const Style& style, Tally& tally, std::stop_token stop)
    : encoder_(std::move(robot), style, post.token),
      style_(style),
      tally_(tally),
      scoring_(post.scoring),
      stop_(std::move(stop)),
      mapping_(post.mapping, stop_) {}

std::optional<HttpReply> Client::send(const Message& message) {
  const MessageKind kind = kind_of(message);
  const HttpRequest request = encoder_.encode(message);
  if (kind == MessageKind::Report || kind == MessageKind::Status) {
    // As teams' scripts do: a fresh connection for each call, so that no report is swallowed by an old one.
    Connection scoring(scoring_, stop_);
    return exchange(scoring, kind, request);
  }
  return exchange(mapping_, kind, request);
}

std::optional<HttpReply> Client::exchange(Connection& connection, MessageKind kind,
                                          const HttpRequest& request) {
  if (!can_send(connection, request)) return std::nullopt;
  const bool report = kind == MessageKind::Report;
  tally_.count(kind, Fate::Posted);
  auto reply = connection.exchange(request, report ? kReportPatience : kPatience, report);
  if (!reply) {
    tally_.count(kind, Fate::Unanswered, reply.error());
    return std::nullopt;
  }
  const Fate fate = is_success(kind, reply->status) ? Fate::Accepted
                    : reply->status == 429          ? Fate::Throttled
                                                    : Fate::Rejected;
  tally_.count(kind, fate, icd::sentence(reply->status, " ", sentence_of(reply->body)));
  return *std::move(reply);
}

bool Client::can_send(Connection& connection, const HttpRequest& request) {
  if (!style_.browser) return true;
  tally_.count(MessageKind::Preflight, Fate::Posted);
  const auto reply = connection.exchange(Encoder::preflight(request), kPatience);
  if (!reply) {
    tally_.count(MessageKind::Preflight, Fate::Unanswered, reply.error());
    return false;
  }
  const bool allowed = reply->status >= 200 && reply->status < 300 &&
                       (reply->allowed_origin == "*" || reply->allowed_origin == Encoder::kOrigin) &&
                       allows(reply->allowed_headers, "authorization");
  tally_.count(MessageKind::Preflight, allowed ? Fate::Accepted : Fate::Rejected,
               icd::sentence(reply->status, " for ", request.method, " ", request.target));
  return allowed;
}

OperatorClient::OperatorClient(Post post, const Style& style, Tally& tally,
                               std::function<void(const std::string&)> say)
    : post_(std::move(post)), style_(style), tally_(tally), say_(std::move(say)) {}

bool OperatorClient::is_news(std::size_t artifact) {
  const std::scoped_lock lock(mutex_);
  return known_.insert(artifact).second;
}

void OperatorClient::submit(Finding finding) {
  const std::scoped_lock lock(mutex_);
  waiting_.push_back(std::move(finding));
  changed_.notify_all();
}

void OperatorClient::work(const std::stop_token& finish, const std::stop_token& abort) {
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

void OperatorClient::ask_status(const std::stop_token& abort) {
  Client client(post_, "operator", style_, tally_, abort);
  const auto reply = client.send(StatusQuery{});
  if (!reply || reply->status != 200) return;  // counted by the client
  if (const auto status = check_status_answer(reply->body); !status)
    tally_.count_failure("GET /api/status: " + status.error());
}

void OperatorClient::print_outcome(const Finding& finding, const std::string& outcome) const {
  const Vector3& at = finding.report.position;
  std::array<char, 80> place{};
  (void)std::snprintf(place.data(), place.size(), " at (%.2f, %.2f, %.2f): ", at.x, at.y, at.z);
  say_(finding.robot + " reports " + finding.report.type + place.data() + outcome);
}

/// A report that was refused with 429 was not recorded and goes again; one whose answer was lost may have
/// been, and does not: that would cost one of the scarce reports.
void OperatorClient::report(const Finding& finding, const std::stop_token& finish,
                            const std::stop_token& abort) {
  Client client(post_, finding.robot, *finding.style, tally_, abort);
  while (!finish.stop_requested()) {
    const auto reply = client.send(finding.report);
    if (!reply) {
      tally_.count_outcome("no answer");
      return print_outcome(finding, "no answer");
    }
    if (reply->status == 429) {
      sleep_until(Clock::now() + kAfter429, finish);
      continue;
    }
    if (reply->status != 200 && reply->status != 201) {
      tally_.count_outcome("rejected with " + std::to_string(reply->status));
      return print_outcome(finding, icd::sentence(reply->status, " ", sentence_of(reply->body)));
    }
    const auto outcome = parse_report_answer(reply->body);
    if (!outcome) {
      tally_.count_failure("POST /api/artifact_reports: " + outcome.error());
      return print_outcome(finding, outcome.error());
    }
    tally_.count_outcome(*outcome);
    return print_outcome(finding, std::to_string(reply->status) + " " + *outcome);
  }
}

}  // namespace adit::robots
