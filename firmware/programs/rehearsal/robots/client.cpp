#include "rehearsal/robots/client.hpp"

#include <algorithm>
#include <utility>

#include "rehearsal/robots/answer.hpp"

namespace adit::robots {
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
  tally_.posted(kind);
  auto reply = connection.exchange(request, report ? kReportPatience : kPatience, report);
  if (!reply) {
    tally_.unanswered(kind, reply.error());
    return std::nullopt;
  }
  if (is_success(kind, reply->status)) {
    tally_.accepted(kind);
  } else if (reply->status == 429) {
    tally_.throttled(kind);
  } else {
    tally_.refused(kind, reply->status, sentence_of(reply->body));
  }
  return *std::move(reply);
}

bool Client::may_send(Connection& connection, const HttpRequest& request) {
  if (!style_.browser) return true;
  tally_.posted(Kind::Preflight);
  const auto reply = connection.exchange(Encoder::preflight(request), kPatience);
  if (!reply) {
    tally_.unanswered(Kind::Preflight, reply.error());
    return false;
  }
  const bool allowed = reply->status >= 200 && reply->status < 300 &&
                       (reply->allowed_origin == "*" || reply->allowed_origin == Encoder::kOrigin) &&
                       allows(reply->allowed_headers, "authorization");
  if (allowed) {
    tally_.accepted(Kind::Preflight);
  } else {
    tally_.refused(Kind::Preflight, reply->status, "for " + request.method + " " + request.target);
  }
  return allowed;
}

}  // namespace adit::robots
