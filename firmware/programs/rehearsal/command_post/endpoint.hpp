#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "rehearsal/command_post/document.hpp"
#include "rehearsal/command_post/messages.hpp"
#include "rehearsal/command_post/run.hpp"

namespace adit::rehearsal {

/// Why the received bytes are not a whole HTTP request. `status` 0: the client is gone and gets no answer.
struct HttpFault {
  int status = 400;
  std::string sentence;
};

/// A request from a connection. If `fault` is set, the other members have the part that could be read.
struct Request {
  std::string method;
  std::string target;
  std::string path;  // of the target, without the slash that this Command Post insists on
  std::optional<std::string> authorization;  // never written anywhere
  std::optional<std::string> content_type;
  std::optional<std::string> content_encoding;
  std::optional<std::string> origin;
  std::string head_fault;  // what RFC 9110 or 9112 forbids of its fields; "": nothing
  bool expects_continue = false;
  bool keep_alive = true;
  std::string body;
  std::string local_address;                    // "127.0.0.1:8000", its destination
  Clock::time_point at;                         // when its header had arrived
  Clock::time_point whole;                      // when its last byte had
  std::chrono::system_clock::time_point ended;  // the same, by the machine's clock
  std::optional<HttpFault> fault;
};

struct Answer {
  int status = 200;
  std::string body = {};
  std::string content_type = "application/json";  // "": no such header
  std::vector<std::pair<std::string, std::string>> headers = {};
};

/// What happens to the connection after the answer, if any.
enum class ConnectionAction {
  KeepOpen,
  Close,                    // saying so (Connection: close)
  CloseThoughPromisingNot,  // as the measured mapping server does after a 4xx
  Reset,                    // with a RST, and unsent bytes are lost
};

/// The reaction to a request, decided before any byte of its answer is written.
struct Outcome {
  enum class Kind {
    Answered,
    Hangs,   // no answer, ever; the connection stays open
    Dies,    // no answer; the endpoint stops listening and drops all its connections
    Breaks,  // `bytes` in place of an answer, and the connection ends
    Later,   // nothing for `delay`; then `then` decides, whether the client is still there or not
  };
  Kind kind = Kind::Answered;
  Answer answer = {};
  ConnectionAction after = ConnectionAction::KeepOpen;
  std::string bytes = {};
  std::chrono::milliseconds delay{0};
  std::function<Outcome()> then = {};  // called while the request still is
};

/// The path of a target in origin form or absolute form (RFC 7230 5.3), without its query.
std::string_view path_of(std::string_view target);

/// The interval between two requests that a rate limit measures.
enum class RateBasis : std::uint8_t {
  Starts,     // from header to header
  LastBytes,  // from last byte to last byte
  Answers,    // from when the one was judged, to be answered, to the header of the next
  Decoded,    // from when the one was decoded to when the next was: the measured mapping server
};

/// "Approximately" `hz` requests a second (ICD 4.1): one that comes sooner than 95 % of the interval after
/// the last one counted is too many, as measured 100 %. 0 Hz: no limit. Safe for use by several threads.
class RateLimit {
 public:
  explicit RateLimit(double hz, RateBasis counted = RateBasis::Starts) : hz_(hz), counted_(counted) {}

  /// Whether the request, which was decoded now, is too many. If it is not, it counts.
  bool is_too_soon(const Request& request);
  /// It was judged now, and counts in any case. If it counted before, the later moment holds.
  void count(const Request& request);

 private:
  void count(const Request& request, Clock::time_point now);

  const double hz_;
  const RateBasis counted_;
  std::mutex mutex_;
  std::optional<Clock::time_point> last_;
};

inline constexpr std::string_view kStatusUri = "/api/status";
inline constexpr std::string_view kReportsUri = "/api/artifact_reports";
inline constexpr std::string_view kMapUri = "/map/update";
inline constexpr std::string_view kStateUri = "/state/update";
inline constexpr std::string_view kMarkersUri = "/markers/update";

/// A function of an endpoint: the method and the URI of one of ICD 5.1 to 6.6.
struct Function {
  std::string_view method;
  std::string_view uri;
};

inline constexpr Function kScoringFunctions[] = {{"GET", kStatusUri}, {"POST", kReportsUri}};
inline constexpr Function kMappingFunctions[] = {
    {"POST", kMapUri}, {"POST", kStateUri}, {"POST", kMarkersUri}};

/// An endpoint's decision about one request, and its findings.
struct Judgement {
  Outcome outcome;
  std::string uri;  // one of the ICD's five, or ""
  Findings findings;
  std::optional<Json> message;        // as it came
  std::optional<OrderedJson> report;  // the answer to a recorded report
  MappingMessage accepted;            // its accepted parts; a report is one
  std::string fault;                  // the rehearsed fault; "": none
};

/// One of the Command Post's two endpoints, of one manner. Safe for use by several threads.
class Endpoint {
 public:
  virtual ~Endpoint() = default;
  virtual Judgement judge(const Request& request) = 0;
};

/// An answer whose body is this JSON.
template <class AnyJson>
Outcome answer_with(int status, const AnyJson& body) {
  return {.answer = {.status = status, .body = line_of(body)}};
}

/// Whether a request has the method and the path of one of the functions.
bool names_one_of(const Request& request, std::span<const Function> functions);

/// The checks of a strict Command Post before it reads a body: the URI is known (404), the token is right
/// (401), no field is missing or repeated (400). The findings hold at most one, which decides.
void check_entry(const Request& request, std::span<const Function> functions, const std::string& token,
                 Findings& findings);

/// The same, and the rate `limit` of its URI. Gives whether the body is to be judged, else the outcome.
bool admit(const Request& request, std::span<const Function> functions, const std::string& token,
           RateLimit* limit, Judgement& judgement);

/// That the body is in a format that the ICD has for this endpoint, and not compressed as a whole.
void check_content(const Request& request, bool cbor_too, Findings& findings);

// The answers to a wrong token and to requests that are too fast, by the ICD and as measured.
inline constexpr std::string_view kWrongToken =
    "Authentication token does not match expected token for this run";
inline constexpr std::string_view kTooManyRequests =
    "Too many requests: limited to approximately 1 per second";
inline constexpr std::string_view kInvalidToken = "Invalid token.";
inline constexpr std::string_view kThrottled = "Request was throttled. Expected available in 1 second.";
inline constexpr std::string_view kTooManyClouds = "Cloud updates too frequent. Reduce to <1Hz.";

/// The measured scoring server takes a path with and without a trailing slash.
std::string_view strip_slash(std::string_view path);

/// An object for a body, as the measured scoring server has it for 400, 401, 405, 415 and 429.
Outcome answer_with_detail(int status, std::string_view detail);

/// HTML, as it has it for 404 and 500.
Outcome page(int status, std::string_view title);

/// Whether a request names a function of the ICD by a path without a slash at its end.
bool lacks_slash(const Request& request);
/// To the path with a slash: by 301 and a whole URL for scoring, by 308 and a path for mapping.
Outcome redirect(const Request& request);

/// A refusal as a JSON string (ICD 4.1).
Outcome answer_refusal(int status, std::string_view sentence);
inline Outcome answer_refusal(const Finding& finding) {
  return answer_refusal(finding.status, finding.sentence);
}

/// The scoring endpoint of the ICD's section 5, to the letter, or the public test server as measured: see
/// each rule in its source. At most `hz` requests a second for each URI, or to the letter for both together
/// (`one_limit`). Without `hz` 1 to the letter, else no limit.
std::unique_ptr<Endpoint> scoring_endpoint(Manner manner, std::string token, std::optional<double> hz,
                                           bool one_limit, Run& run);

/// The body of an answer to POST /api/artifact_reports (ICD 5.2). x, y, z and type are given back as they
/// came; `authority`: the address and port in its url.
OrderedJson report_body(const Run::Ruling& ruling, const Json& sent, const std::string& authority);

/// If no address is known, or as the measured server shows it.
inline constexpr const char* kNoAuthority = "<ipaddress>:<port>";

/// The same for mapping, the ICD's section 6. At most `hz` requests a second for each URI; as measured,
/// clouds of all robots together. Without `hz` 1. `counted`: absent: by the manner.
std::unique_ptr<Endpoint> mapping_endpoint(Manner manner, std::string token, std::optional<double> hz,
                                           std::optional<RateBasis> counted);

}  // namespace adit::rehearsal
