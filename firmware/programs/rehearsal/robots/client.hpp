#pragma once

#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http.hpp>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <expected>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <stop_token>
#include <string>
#include <string_view>
#include <utility>

#include "rehearsal/common.hpp"
#include "rehearsal/robots/messages.hpp"

namespace adit::robots {

/// Where to post: "http://ADDR:PORT", or "localhost" as the address. The error is a sentence about `url`.
std::expected<Address, std::string> parse_url(std::string_view url);

struct HttpReply {
  int status = 0;
  std::string body;
  std::string allowed_origin, allowed_headers;  // Access-Control-Allow-*, where there
};

/// A client's connection, kept alive between requests and opened again where the server has closed it. Each
/// request ends at its deadline, or within 50 ms of `stop`.
class Connection {
 public:
  Connection(Address server, std::stop_token stop) : server_(std::move(server)), stop_(std::move(stop)) {}

  /// The reply, whatever its status; or why there is none. A request that a kept connection swallowed is
  /// sent once more on a fresh one, unless `send_once`.
  std::expected<HttpReply, std::string> exchange(const HttpRequest& request, std::chrono::milliseconds time,
                                                 bool send_once = false);

 private:
  using Body = boost::beast::http::string_body;

  template <class Start>
  boost::system::error_code await(Start start);
  void close();
  boost::system::error_code transfer(boost::beast::http::request<Body>& message,
                                     boost::beast::http::response_parser<Body>& parser);

  const Address server_;
  const std::stop_token stop_;
  boost::asio::io_context context_{1};
  boost::asio::ip::tcp::socket socket_{context_};
  boost::beast::flat_buffer buffer_;
  std::chrono::steady_clock::time_point deadline_;
};

/// What a client shows its operator of a refusal: the JSON string or {"detail": ...} that the server sent,
/// else the first line of the body ("not JSON: ...").
std::string sentence_of(std::string_view body);

/// "scored +1", of the answer to a report (ICD 5.2); or which member that clients insist on is not there as
/// it should be.
std::expected<std::string, std::string> parse_report_answer(std::string_view body);

/// Or the fault of the answer to GET /api/status.
std::expected<void, std::string> check_status_answer(std::string_view body);

/// The fate of a message. Throttled: 429, which is normal for a fast team.
enum class Fate : std::uint8_t { Posted, Accepted, Throttled, Rejected, Unanswered };

/// The posted messages and their outcomes. Any thread may write to it.
class Tally {
 public:
  /// `why`: the refusal's status and sentence, or why there was no answer.
  void count(MessageKind kind, Fate fate, const std::string& why = "");
  /// What an answered report came to: "scored +1", "run not started", ...
  void count_outcome(const std::string& outcome);
  /// Something of the team's own that is wrong, such as a map file.
  void count_failure(const std::string& what);

  std::uint64_t accepted_of(MessageKind kind) const;

  /// Whether nothing was refused but by 429, and nothing failed.
  bool clean() const;

  /// "grid 12/12, cloud 9/12, ...": accepted of posted, for a line that lives.
  std::string line() const;

  /// Lines for a person: a row for each kind, then each refusal, then the reports.
  std::string summary() const;

 private:
  static constexpr std::size_t kFates = 5;
  using Row = std::array<std::uint64_t, kFates>;  // by fate

  static std::uint64_t times(const Row& row, Fate fate) { return row[static_cast<std::size_t>(fate)]; }

  mutable std::mutex mutex_;  // guards all below
  std::array<Row, kKinds> rows_{};
  std::map<std::string, std::uint64_t> rejections_;  // "markers: 422 ..."
  std::map<std::string, std::uint64_t> silences_;
  std::map<std::string, std::uint64_t> reports_;
  std::map<std::string, std::uint64_t> failures_;
};

/// Where a team's messages go, and with which token.
struct Post {
  Address mapping;
  Address scoring;  // the same as `mapping` unless a Command Post is spoken to without a gateway
  std::string token;
};

/// One client of the team: posts messages in its style and counts the answers. For one thread.
class Client {
 public:
  /// `style` and `tally` outlive the client.
  Client(const Post& post, std::string robot, const Style& style, Tally& tally, std::stop_token stop);

  /// The reply, counted as accepted (200; a report also 201), throttled or refused; or nothing where none
  /// came, counted too. Waits 30 s for the answer to a report, 5 s for any other.
  std::optional<HttpReply> send(const Message& message);

 private:
  std::optional<HttpReply> exchange(Connection& connection, MessageKind kind, const HttpRequest& request);
  bool can_send(Connection& connection, const HttpRequest& request);

  Encoder encoder_;
  const Style& style_;
  Tally& tally_;
  Address scoring_;
  std::stop_token stop_;
  Connection mapping_;
};

/// Sleeps until `time`, or less where `stop` is requested.
inline void sleep_until(std::chrono::steady_clock::time_point time, const std::stop_token& stop) {
  std::mutex mutex;
  std::condition_variable_any never;
  std::unique_lock lock(mutex);
  (void)never.wait_until(lock, stop, time, [] { return false; });
}

/// Submits the robots' findings for the operator, each once, in turn. Asks for the status now and then.
class OperatorClient {
 public:
  /// `say` prints a line. `style`, in which it asks for the status, and `tally` must outlive this object.
  OperatorClient(Post post, const Style& style, Tally& tally, std::function<void(const std::string&)> say);

  struct Finding {
    std::string robot;
    const Style* style = nullptr;  // the report goes out as the robot's own software writes it
    Report report;
  };

  /// Whether `artifact` (its number in the cave) is news; from any thread.
  bool is_news(std::size_t artifact);
  void submit(Finding finding);

  /// Works until `finish`, and then waits for the answer that is on its way; gives that up at `abort`.
  void work(const std::stop_token& finish, const std::stop_token& abort);

 private:
  void ask_status(const std::stop_token& abort);
  void report(const Finding& finding, const std::stop_token& finish, const std::stop_token& abort);
  void print_outcome(const Finding& finding, const std::string& outcome) const;

  Post post_;
  const Style& style_;
  Tally& tally_;
  std::function<void(const std::string&)> say_;

  std::mutex mutex_;  // guards all below
  std::condition_variable_any changed_;
  std::deque<Finding> waiting_;
  std::set<std::size_t> known_;
};

}  // namespace adit::robots
