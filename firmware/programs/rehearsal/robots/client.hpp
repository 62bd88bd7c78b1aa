#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <expected>
#include <map>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>

#include "rehearsal/robots/encode.hpp"
#include "rehearsal/robots/http.hpp"
#include "rehearsal/robots/messages.hpp"

namespace adit::robots {

/// What was posted and what came of it. Any thread may write to it.
class Tally {
 public:
  void posted(Kind kind);
  void accepted(Kind kind);
  /// 429: the team went too fast, which is normal.
  void throttled(Kind kind);
  /// Any other refusal.
  void refused(Kind kind, int status, const std::string& sentence);
  /// No answer came, for `reason`.
  void unanswered(Kind kind, const std::string& reason);
  /// What an answered report came to: "scored +1", "run not started", ...
  void report_came_to(const std::string& outcome);
  /// Something of the team's own that is wrong, such as a map file.
  void failed(const std::string& what);

  std::uint64_t accepted_of(Kind kind) const;

  /// Whether nothing was refused but by 429, and nothing failed.
  bool clean() const;

  /// "grid 12/12, cloud 9/12, ...": accepted of posted, for a line that lives.
  std::string line() const;

  /// Lines for a person: a row for each kind, then each refusal, then the reports.
  std::string summary() const;

 private:
  struct Row {
    std::uint64_t posted = 0, accepted = 0, throttled = 0, refused = 0, unanswered = 0;
  };
  Row& row(Kind kind) { return rows_[static_cast<std::size_t>(kind)]; }

  mutable std::mutex mutex_;  // guards all below
  std::array<Row, kKinds> rows_{};
  std::map<std::string, std::uint64_t> refusals_;  // "markers: 422 ..."
  std::map<std::string, std::uint64_t> silences_;
  std::map<std::string, std::uint64_t> reports_;
  std::map<std::string, std::uint64_t> failures_;
};

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
