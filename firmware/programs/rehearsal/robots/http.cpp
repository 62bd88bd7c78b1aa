#include "rehearsal/robots/http.hpp"

#include <algorithm>
#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http.hpp>
#include <charconv>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <optional>

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

}  // namespace adit::robots
