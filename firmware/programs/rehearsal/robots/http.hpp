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

}  // namespace adit::robots
