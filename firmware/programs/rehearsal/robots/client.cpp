#include "rehearsal/robots/client.hpp"

#include <algorithm>
#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http.hpp>
#include <charconv>
#include <cstdio>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

namespace adit::robots {

namespace {

namespace asio = boost::asio;
namespace http = boost::beast::http;
using asio::ip::tcp;
using boost::system::error_code;
using Clock = std::chrono::steady_clock;

constexpr std::uint64_t kLargestReply = 1 << 20;

}  // namespace

std::expected<Endpoint, std::string> parse_url(std::string_view url) {
  const auto wrong = [&](std::string_view why) {
    return std::unexpected("expected http://ADDR:PORT, got '" + std::string(url) + "': " + std::string(why));
  };
  constexpr std::string_view kScheme = "http://";
  if (!url.starts_with(kScheme)) return wrong("it does not start with http://");
  std::string_view rest = url.substr(kScheme.size());
  if (rest.ends_with('/')) rest.remove_suffix(1);
  const std::size_t colon = rest.rfind(':');
  if (colon == std::string_view::npos) return wrong("no port");
  std::string_view address = rest.substr(0, colon);
  const std::string_view port = rest.substr(colon + 1);
  if (address.starts_with('[') && address.ends_with(']')) address = address.substr(1, address.size() - 2);
  Endpoint endpoint{.address = std::string(address), .port = 0};
  const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), endpoint.port);
  if (error != std::errc{} || end != port.data() + port.size() || endpoint.port == 0) {
    return wrong("the port is not a number from 1 to 65535");
  }
  error_code bad;
  if (endpoint.address == "localhost") endpoint.address = "127.0.0.1";
  (void)asio::ip::make_address(endpoint.address, bad);
  if (bad) return wrong("the address is not an IP address");
  return endpoint;
}

/// Asio's asynchronous calls, run one at a time, so that each has a deadline and can be stopped.
struct Connection::Wire {
  Wire(Endpoint at, std::stop_token stopped) : endpoint(std::move(at)), stop(std::move(stopped)) {}

  template <class Start>
  error_code await(Start start) {
    std::optional<error_code> result;
    start([&result](error_code error, auto&&...) { result = error; });
    context.restart();
    while (!result) {
      if (stop.stop_requested() || Clock::now() >= deadline) {
        close();
        context.run();
        return asio::error::timed_out;
      }
      context.run_for(std::chrono::milliseconds(20));
    }
    return *result;
  }

  error_code open() {
    buffer.clear();
    const tcp::endpoint peer(asio::ip::make_address(endpoint.address), endpoint.port);
    const error_code error = await([&](auto done) { socket.async_connect(peer, done); });
    if (error) {
      close();
      return error;
    }
    error_code ignored;  // latency alone
    (void)socket.set_option(tcp::no_delay(true), ignored);
    return error;
  }

  void close() {
    error_code ignored;  // nothing to be done about a socket that does not close
    (void)socket.close(ignored);
  }

  error_code transfer(http::request<http::string_body>& message,
                      http::response_parser<http::string_body>& parser) {
    error_code error = await([&](auto done) { http::async_write(socket, message, done); });
    if (!error) error = await([&](auto done) { http::async_read(socket, buffer, parser, done); });
    if (error || !parser.keep_alive()) close();
    return error;
  }

  std::string reason(const error_code& error, std::chrono::milliseconds time) const {
    if (stop.stop_requested()) return "stopped before the answer arrived";
    if (error == asio::error::timed_out) return "no answer within " + std::to_string(time.count()) + " ms";
    if (error == http::error::end_of_stream) return "connection closed without an answer";
    return error.message();
  }

  Endpoint endpoint;
  std::stop_token stop;
  asio::io_context context{1};
  tcp::socket socket{context};
  boost::beast::flat_buffer buffer;
  Clock::time_point deadline;
};

Connection::Connection(Endpoint endpoint, std::stop_token stop)
    : wire_(std::make_unique<Wire>(std::move(endpoint), std::move(stop))) {}

Connection::~Connection() = default;

std::expected<HttpReply, std::string> Connection::exchange(const HttpRequest& request,
                                                           std::chrono::milliseconds time, bool send_once) {
  http::request<http::string_body> message{http::string_to_verb(request.method), request.target, 11};
  const bool ipv6 = wire_->endpoint.address.find(':') != std::string::npos;
  message.set(http::field::host, (ipv6 ? "[" + wire_->endpoint.address + "]" : wire_->endpoint.address) +
                                     ":" + std::to_string(wire_->endpoint.port));
  for (const auto& [name, value] : request.fields) message.set(name, value);
  message.body() = request.body;
  message.prepare_payload();

  wire_->deadline = Clock::now() + time;
  while (true) {
    const bool kept = wire_->socket.is_open();
    if (!kept) {
      if (const error_code error = wire_->open()) return std::unexpected(wire_->reason(error, time));
    }
    http::response_parser<http::string_body> parser;
    parser.body_limit(kLargestReply);
    const error_code error = wire_->transfer(message, parser);
    if (!error) {
      auto reply = parser.release();
      return HttpReply{.status = static_cast<int>(reply.result_int()),
                       .body = std::move(reply.body()),
                       .allowed_origin = std::string(reply[http::field::access_control_allow_origin]),
                       .allowed_headers = std::string(reply[http::field::access_control_allow_headers])};
    }
    const bool swallowed = kept && !parser.got_some() && error != asio::error::timed_out;
    if (send_once || !swallowed) return std::unexpected(wire_->reason(error, time));
  }
}

namespace {

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
      return std::string("the answer's '") + name + "' is not a number";
  }
  for (const char* name : texts) {
    if (!answer.contains(name) || !answer[name].is_string())
      return std::string("the answer's '") + name + "' is not a string";
  }
  return "";
}

}  // namespace

std::string sentence_of(std::string_view body) {
  if (body.empty()) return "(empty body)";
  const Json json = parse(body);
  if (json.is_string()) return json.get<std::string>();
  if (json.is_object() && json.contains("detail") && json["detail"].is_string()) {
    return json["detail"].get<std::string>();
  }
  constexpr std::size_t kShown = 100;
  std::string line(body.substr(0, std::min(body.find('\n'), kShown)));
  std::ranges::replace_if(line, [](char c) { return c < ' ' || c > '~'; }, '?');
  return (json.is_discarded() ? "not JSON: " : "") + line;
}

std::expected<std::string, std::string> parse_report_answer(std::string_view body) {
  const Json answer = parse(body);
  const std::string wrong =
      wrong_member(answer, {"x", "y", "z", "run_clock", "score_change"}, {"type", "report_status"});
  if (!wrong.empty()) return std::unexpected(wrong);
  const int change = static_cast<int>(std::clamp(answer["score_change"].get<double>(), -99.0, 99.0));
  return answer["report_status"].get<std::string>() + (change < 0 ? " " : " +") + std::to_string(change);
}

std::expected<void, std::string> check_status_answer(std::string_view body) {
  const Json answer = parse(body);
  const char* const clock = answer.contains("run_clock") ? "run_clock" : "clock";  // ICD 5.1 has both
  const std::string wrong = wrong_member(answer, {"score", "remaining_reports", clock}, {});
  if (!wrong.empty()) return std::unexpected(wrong);
  return {};
}

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
