#include "rehearsal/command_post/endpoint.hpp"

#include <algorithm>

#include "icd/sentence.hpp"

namespace adit::rehearsal {

std::string_view path_of(std::string_view target) {
  constexpr std::string_view scheme = "http://";
  if (target.starts_with(scheme)) {
    const auto slash = target.find('/', scheme.size());
    target = slash == std::string_view::npos ? "/" : target.substr(slash);
  }
  return target.substr(0, target.find('?'));
}

bool RateLimit::is_too_soon(const Request& request) {
  const std::lock_guard lock(mutex_);
  const double tolerance = counted_ == RateBasis::Decoded ? 1 : 0.95;
  const Clock::time_point now = Clock::now();
  const Clock::time_point comes = counted_ == RateBasis::LastBytes ? request.whole
                                  : counted_ == RateBasis::Decoded ? now
                                                                   : request.at;
  if (hz_ > 0 && last_ && comes - *last_ < std::chrono::duration<double>(tolerance / hz_)) return true;
  count(request, now);
  return false;
}

void RateLimit::count(const Request& request) {
  const std::lock_guard lock(mutex_);
  count(request, Clock::now());
}

void RateLimit::count(const Request& request, Clock::time_point now) {
  const Clock::time_point counts = counted_ == RateBasis::Starts      ? request.at
                                   : counted_ == RateBasis::LastBytes ? request.whole
                                                                      : now;
  last_ = last_ ? std::max(*last_, counts) : counts;
}

bool names_one_of(const Request& request, std::span<const Function> functions) {
  return std::ranges::any_of(functions, [&](const Function& function) {
    return function.method == request.method && function.uri == request.path;
  });
}

void check_entry(const Request& request, std::span<const Function> functions, const std::string& token,
                 Findings& findings) {
  if (!names_one_of(request, functions)) {
    findings.add_violation("URI is not recognized: " + request.method + " " + request.path.substr(0, 200),
                           Measured::Refuses, 404);
  } else if (!request.authorization) {
    findings.add_violation("No authentication token was provided", Measured::Refuses, 401);
  } else if (*request.authorization != "Bearer " + token) {
    findings.add_violation(std::string(kWrongToken), Measured::Refuses, 401);
  } else if (!request.head_fault.empty()) {
    findings.add_violation(request.head_fault, Measured::Takes, 400);
  }
}

bool admit(const Request& request, std::span<const Function> functions, const std::string& token,
           RateLimit* limit, Judgement& judgement) {
  check_entry(request, functions, token, judgement.findings);
  const Finding* const finding = judgement.findings.first_rejected(Manner::Strict);
  if (finding == nullptr || finding->status != 404) judgement.uri = request.path;
  if (finding == nullptr && !limit->is_too_soon(request)) return true;
  judgement.outcome = finding != nullptr ? answer_refusal(*finding) : answer_refusal(429, kTooManyRequests);
  return false;
}

void check_content(const Request& request, bool cbor_too, Findings& findings) {
  if (request.content_encoding) {
    findings.add_violation("Content-Encoding: the ICD has none for a whole body", Measured::Takes);
  }
  const bool known =
      request.content_type == "application/json" || (cbor_too && request.content_type == "application/cbor");
  if (!known) {
    findings.add_violation(icd::sentence("Content-Type: expected application/json",
                                         cbor_too ? " or application/cbor" : "", ", without parameters"));
  }
}

std::string_view strip_slash(std::string_view path) {
  while (path.size() > 1 && path.ends_with('/')) path.remove_suffix(1);
  return path;
}

Outcome answer_with_detail(int status, std::string_view detail) {
  return answer_with(status, OrderedJson{{"detail", detail}});
}

Outcome page(int status, std::string_view title) {
  return {.answer = {.status = status,
                     .body = icd::sentence("<!doctype html>\n<html lang=\"en\"><head><title>", title,
                                           "</title></head><body><h1>", title, "</h1></body></html>\n"),
                     .content_type = "text/html"}};
}

bool lacks_slash(const Request& request) {
  constexpr auto is = [](const Request& asked, std::span<const Function> functions) {
    return std::ranges::find(functions, asked.path, &Function::uri) != functions.end();
  };
  return path_of(request.target) == request.path &&
         (is(request, kScoringFunctions) || is(request, kMappingFunctions));
}

Outcome redirect(const Request& request) {
  constexpr int kMovedPermanently = 301, kPermanentRedirect = 308;
  const bool is_scoring = request.path.starts_with("/api/");
  Outcome outcome = page(is_scoring ? kMovedPermanently : kPermanentRedirect, "Redirecting");
  const std::string there = is_scoring ? "http://" + request.local_address : "";
  outcome.answer.headers.emplace_back("Location", there + request.path + "/");
  return outcome;
}

Outcome answer_refusal(int status, std::string_view sentence) {
  return answer_with(status, Json(sentence));
}

}  // namespace adit::rehearsal
