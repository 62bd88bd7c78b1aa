#include <algorithm>
#include <expected>
#include <map>
#include <mutex>
#include <utility>

#include "rehearsal/command_post/document.hpp"
#include "rehearsal/command_post/endpoint.hpp"

namespace adit::rehearsal {
namespace {

Format format_of(const Request& request) {
  return request.content_type == "application/cbor" ? Format::CborBytes : Format::JsonText;
}

/// Said where a message could not be read and no finding tells why.
constexpr const char* kUnreadable = "The message could not be read";

/// ICD 6.2: a URI's stamps never run backward, in a message or between two; equal ones are fine. Thread-safe.
class StampOrder {
 public:
  /// Records the first stamp that ran back. A message that passes, or is `taken_anyhow`, counts from then on.
  void check(const std::string& uri, const std::vector<Stamp>& stamps, bool taken_anyhow,
             Findings& findings) {
    const std::lock_guard lock(mutex_);
    double latest = latest_[uri];  // stamps are not negative
    bool forward = true;
    for (const Stamp& stamp : stamps) {
      if (stamp.seconds < latest && forward) {
        forward = false;
        findings.add_violation(stamp.path + ": runs backward, " + line_of(Json(stamp.seconds)) + " after " +
                                   line_of(Json(latest)) + " (ICD 6.2)",
                               Measured::Takes);
      }
      latest = std::max(latest, stamp.seconds);
    }
    if (forward || taken_anyhow) latest_[uri] = latest;
  }

 private:
  std::mutex mutex_;
  std::map<std::string, double> latest_;
};

class StrictMapping : public Endpoint {
 public:
  StrictMapping(std::string token, double hz, RateBasis counted) : token_(std::move(token)) {
    for (const Function& function : kMappingFunctions)
      limits_.try_emplace(std::string(function.uri), hz, counted);
  }

  Judgement judge(const Request& request) override {
    Judgement judgement;
    const auto found = limits_.find(request.path);
    RateLimit* const limit = found == limits_.end() ? nullptr : &found->second;
    if (!admit(request, kMappingFunctions, token_, limit, judgement)) return judgement;
    judge_body(request, judgement);
    limit->count(request);  // its answer follows
    return judgement;
  }

 private:
  void judge_body(const Request& request, Judgement& judgement) {
    Findings& findings = judgement.findings;
    const auto decisive = [&findings] { return findings.first_rejected(Manner::Strict); };
    check_content(request, true, findings);
    std::optional<MappingMessage> message;
    if (decisive() == nullptr) message = read_mapping(request.body, format_of(request), judgement);
    if (message && decisive() == nullptr) stamps_.check(judgement.uri, message->stamps, false, findings);
    judgement.outcome = decisive() != nullptr ? answer_refusal(*decisive())
                        : message             ? answer_with(200, Json(nullptr))
                                              : answer_refusal(422, kUnreadable);
    if (message && decisive() == nullptr) judgement.accepted = *std::move(message);
  }

  const std::string token_;
  StampOrder stamps_;
  std::map<std::string, RateLimit> limits_;  // by URI
};

/// After a 4xx it promises keep-alive and closes.
Outcome closing(Outcome outcome) {
  if (outcome.answer.status >= 400 && outcome.answer.status < 500)
    outcome.after = ConnectionAction::CloseThoughPromisingNot;
  return outcome;
}

/// An unknown URI or a method other than POST: 501 without a body.
Outcome not_implemented() {
  return {.answer = {.status = 501, .content_type = ""}};
}

/// It takes bodies that are compressed as a whole.
std::expected<std::string, InflateFault> read_body(const Request& request) {
  constexpr std::size_t most = std::size_t{512} << 20;
  if (request.content_encoding == "gzip") return gunzip(request.body, most);
  if (request.content_encoding == "deflate") return inflate_body(request.body, most);
  return request.body;
}

Outcome outcome_of(const Finding& finding) {
  Outcome outcome = closing(answer_refusal(finding));
  if (finding.measured == Measured::Dies) outcome.kind = Outcome::Kind::Dies;
  if (finding.measured == Measured::Hangs) outcome.kind = Outcome::Kind::Hangs;
  return outcome;
}

class MeasuredMapping : public Endpoint {
 public:
  MeasuredMapping(std::string token, double hz, RateBasis counted)
      : token_(std::move(token)), cloud_limit_(hz, counted) {}

  Judgement judge(const Request& request) override {
    Judgement judgement;
    check_entry(request, kMappingFunctions, token_, judgement.findings);
    const auto& found = judgement.findings.all();
    const bool known = found.empty() || found.front().status != 404;
    if (known) judgement.uri = request.path;
    if (!known) {
      judgement.outcome = not_implemented();
    } else if (!found.empty()) {  // its match of the whole Authorization header is exact, as ours is
      judgement.outcome = closing(answer_refusal(found.front()));
    } else {
      judge_body(request, judgement);
    }
    return judgement;
  }

 private:
  void judge_body(const Request& request, Judgement& judgement) {
    Findings& findings = judgement.findings;
    check_content(request, true, findings);
    if (request.content_type != "application/json" && request.content_type != "application/cbor") {
      judgement.outcome = closing(answer_refusal(422, "Unknown Content-Type"));
      return;
    }
    const auto body = read_body(request);
    if (!body) {
      judgement.outcome = closing(answer_refusal(400, "The body is not what Content-Encoding says"));
      return;
    }
    auto message = read_mapping(*body, format_of(request), judgement);
    if (const Finding* const finding = findings.first_rejected(Manner::AsMeasured)) {
      judgement.outcome = outcome_of(*finding);
      return;
    }
    if (!message) {
      judgement.outcome = closing(answer_refusal(422, kUnreadable));
      return;
    }
    stamps_.check(judgement.uri, message->stamps, true, findings);
    judgement.outcome = answer_with(200, Json(nullptr));
    if (message->map && std::holds_alternative<Cloud>(message->map->msg)) {
      // Too many clouds are answered with 429, and accepted: each counts.
      if (cloud_limit_.is_too_soon(request)) judgement.outcome = closing(answer_refusal(429, kTooManyClouds));
      cloud_limit_.count(request);
    }
    judgement.accepted = *std::move(message);
  }

  const std::string token_;
  StampOrder stamps_;
  RateLimit cloud_limit_;
};

}  // namespace

std::unique_ptr<Endpoint> mapping_endpoint(Manner manner, std::string token, std::optional<double> hz,
                                           std::optional<RateBasis> counted) {
  const double most = hz.value_or(1);
  if (manner == Manner::Strict)
    return std::make_unique<StrictMapping>(std::move(token), most, counted.value_or(RateBasis::Starts));
  return std::make_unique<MeasuredMapping>(std::move(token), most, counted.value_or(RateBasis::Decoded));
}

}  // namespace adit::rehearsal
