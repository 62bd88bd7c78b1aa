#pragma once

#include <chrono>
#include <expected>
#include <optional>
#include <stop_token>
#include <string>

#include "rehearsal/robots/encode.hpp"
#include "rehearsal/robots/http.hpp"
#include "rehearsal/robots/tally.hpp"

namespace adit::robots {

/// Where a team's messages go, and with which token.
struct Post {
  Endpoint mapping;
  Endpoint scoring;  // the same as `mapping` unless a Command Post is spoken to without a gateway
  std::string token;
};

/// One client of the team: posts messages in its style and counts what comes of them. For one thread.
class Client {
 public:
  /// `style` and `tally` outlive the client.
  Client(const Post& post, std::string robot, const Style& style, Tally& tally, std::stop_token stop);

  /// The reply, counted as accepted (200; a report also 201), throttled or refused; or nothing where none
  /// came, counted too. Waits 30 s for the answer to a report, 5 s for any other.
  std::optional<HttpReply> send(const Message& message);

 private:
  std::optional<HttpReply> exchange(Connection& connection, Kind kind, const HttpRequest& request);
  bool may_send(Connection& connection, const HttpRequest& request);

  Encoder encoder_;
  const Style& style_;
  Tally& tally_;
  Endpoint scoring_;
  std::stop_token stop_;
  Connection mapping_;
};

}  // namespace adit::robots
