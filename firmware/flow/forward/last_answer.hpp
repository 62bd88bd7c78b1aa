#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "icd/uri.hpp"
#include "loop/loop.hpp"
#include "uplink/connection.hpp"

namespace adit::forward {

/// The last outcome of the requests to an endpoint, and counts of all.
class LastAnswer {
 public:
  struct Request {
    icd::Uri uri;
    loop::Instant sent_at;
    std::size_t bytes = 0;  // of its body
    /// Only counted: a trial of another path, or of a message that failed alone before, has failed again.
    bool is_vain = false;
  };

  explicit LastAnswer(loop::Loop& loop) : loop_(loop) {}

  void note(const Request& request, const uplink::Outcome& outcome);
  /// The endpoint is another from now on. Keeps the counts and the time.
  void forget();

  /// Why the last request has no good answer, or "".
  const std::string& trouble() const { return trouble_; }
  /// HTTP status; 0: no answer.
  int status() const { return status_; }
  /// From the request's first byte until its answer.
  std::optional<double> answer_ms() const { return answer_ms_; }
  /// True if it came from another machine than a Command Post. foreign() counts such answers.
  bool is_foreign() const { return is_foreign_; }
  std::uint64_t foreign() const { return foreign_; }
  std::uint64_t ended() const { return ended_; }          // requests, without vain ones
  std::uint64_t throttled() const { return throttled_; }  // answers 429
  loop::Instant heard() const { return heard_; }
  /// The Command Post's time of day now, in seconds since 1970, by the last Date that is certainly its own.
  std::optional<double> time_there() const;

 private:
  loop::Loop& loop_;
  loop::Instant heard_{};
  std::uint64_t ended_ = 0, throttled_ = 0, foreign_ = 0;
  bool is_foreign_ = false;
  int status_ = 0;
  std::optional<double> answer_ms_;
  std::optional<double> date_;  // seconds since 1970, at dated_
  loop::Instant dated_{};
  std::string trouble_;
};

/// Why a request has no answer, or the text of its answer.
std::string sentence_of(const uplink::Outcome& outcome);
/// The same for a map, a state or markers with a body of `bytes`, which a proxy may have answered with 413.
std::string sentence_of(const uplink::Outcome& outcome, std::size_t bytes);

}  // namespace adit::forward
