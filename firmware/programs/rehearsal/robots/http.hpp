#pragma once

#include <chrono>
#include <cstdint>
#include <expected>
#include <memory>
#include <stop_token>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace adit::robots {

/// Where to post: http://ADDR:PORT.
struct Endpoint {
  std::string address;  // numeric, or "localhost"
  std::uint16_t port = 0;
};

/// Or a sentence that says what is wrong with `url`.
std::expected<Endpoint, std::string> parse_url(std::string_view url);

struct HttpRequest {
  std::string method;
  std::string target;
  std::vector<std::pair<std::string, std::string>> fields;  // beside Host and Content-Length
  std::string body;
};

struct HttpReply {
  int status = 0;
  std::string body;
  std::string allowed_origin, allowed_headers;  // Access-Control-Allow-*, where there
};

/// A client's connection, kept alive between requests and opened again where the server has closed it. Each
/// request ends at its deadline, or within 50 ms of `stop`.
class Connection {
 public:
  Connection(Endpoint endpoint, std::stop_token stop);
  ~Connection();
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  /// The reply, whatever its status; or why there is none. A request that a kept connection swallowed is
  /// sent once more on a fresh one, unless `send_once`.
  std::expected<HttpReply, std::string> exchange(const HttpRequest& request, std::chrono::milliseconds time,
                                                 bool send_once = false);

 private:
  struct Wire;
  std::unique_ptr<Wire> wire_;
};

/// What a client shows its operator of a refusal: the JSON string or {"detail": ...} that the server sent,
/// else the first line of the body ("not JSON: ...").
std::string sentence_of(std::string_view body);

/// "scored +1", of the answer to a report (ICD 5.2); or which member that clients insist on is not there as
/// it should be.
std::expected<std::string, std::string> parse_report_answer(std::string_view body);

/// Or the fault of the answer to GET /api/status.
std::expected<void, std::string> check_status_answer(std::string_view body);

}  // namespace adit::robots
