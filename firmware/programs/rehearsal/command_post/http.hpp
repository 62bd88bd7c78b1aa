#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace adit::rehearsal {

using Clock = std::chrono::steady_clock;

/// Why what came in is no whole HTTP request. `status` 0: whoever sent it is gone and gets no answer.
struct HttpFault {
  int status = 400;
  std::string sentence;
};

/// A request as it was read from a connection. Where `fault` is set, the rest holds what was understood.
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
  std::string local_address;                    // "127.0.0.1:8000", where it was sent to
  Clock::time_point at;                         // when its header had arrived
  Clock::time_point whole;                      // when its last byte had
  std::chrono::system_clock::time_point ended;  // the same, by the machine's clock
  std::optional<HttpFault> fault;
};

/// The path of a target in origin form or absolute form (RFC 7230 5.3), without its query.
std::string_view path_of(std::string_view target);

/// In UTC, by a format of strftime(3). No program here has a locale.
std::string utc_text(const char* format, std::chrono::system_clock::time_point time);

struct Answer {
  int status = 200;
  std::string body;
  std::string content_type = "application/json";  // "": no such header
  std::vector<std::pair<std::string, std::string>> headers;
};

/// What becomes of the connection once the answer, if any, is written.
enum class After {
  KeepOpen,
  Close,                    // saying so (Connection: close)
  CloseThoughPromisingNot,  // as the measured mapping server does after a 4xx
  Reset,                    // with a RST, and what was not yet sent is lost
};

/// What is done about a request, decided before any byte of it is written.
struct Outcome {
  enum class Kind {
    Answered,
    Hangs,   // no answer, ever; the connection stays open
    Dies,    // no answer; the endpoint stops listening and drops all its connections
    Breaks,  // `bytes` in place of an answer, and the connection ends
    Later,   // nothing for `delay`; then `then` decides, whether the client is still there or not
  };
  Kind kind = Kind::Answered;
  Answer answer;
  After after = After::KeepOpen;
  std::string bytes;
  std::chrono::milliseconds delay{0};
  std::function<Outcome()> then;  // called while the request still is
};

/// The answer's bytes as they go to the socket; without its body for a HEAD request. Dated, as what has a
/// clock must do (RFC 9110 6.6.1).
std::string bytes_of(const Outcome& outcome, bool head, std::chrono::system_clock::time_point now);

}  // namespace adit::rehearsal
