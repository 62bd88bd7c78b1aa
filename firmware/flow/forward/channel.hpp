#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "icd/uri.hpp"
#include "intake/server.hpp"
#include "loop/loop.hpp"
#include "settings/settings.hpp"
#include "uplink/connection.hpp"

namespace adit::forward {

/// The client's answer, with the same status. JSON of a 2xx and JSON strings are copied. An object becomes
/// the string of its `detail` (ICD 4.1), other bytes a sentence (404 and 500 may be HTML, 501 is empty). A
/// 2xx without JSON becomes 502.
intake::Answer client_answer(const uplink::Answered& answered);

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
  /// Seconds since answer_time().
  double age() const { return std::chrono::duration<double>(loop_.now() - heard_).count(); }
  /// True if it came from another machine than a Command Post. foreign() counts such answers.
  bool is_foreign() const { return is_foreign_; }
  std::uint64_t foreign() const { return foreign_; }
  std::uint64_t ended_requests() const { return ended_; }         // requests, without vain ones
  std::uint64_t throttled_answers() const { return throttled_; }  // answers 429
  loop::Instant answer_time() const { return heard_; }
  /// The Command Post's time of day now, in seconds since 1970, by the last Date that is certainly its own.
  std::optional<double> command_post_time() const;

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

struct EndpointAccess {
  uplink::Endpoint endpoint;
  std::optional<icd::BearerToken> token;
  std::chrono::milliseconds answer_within;
};

/// A connection to an endpoint of the Command Post, with one request in flight, or two if the second goes
/// ahead (uplink::Connections). Without a token no connection is opened.
///
/// After a redirect to the same path with a slash, later paths end with a slash, until the endpoint does not
/// know such a path or redirects to the path without it. A redirect of a report counts for reports alone, and
/// only a 307 or 308. If a status is a web page, the next request for it has the other form of the path, as a
/// trial: some servers want a slash and do not redirect. The channel repeats no request.
class Channel {
 public:
  /// `name`: "scoring" or "mapping". `turn_came`: call claim_turn() again.
  Channel(loop::Loop& loop, uplink::Servers& servers, const char* name, EndpointAccess way,
          std::function<void()> turn_came);

  /// Changes the way by a new connection, after the requests in flight.
  void lead_to(EndpointAccess way) { next_ = std::move(way); }
  /// If the next way has another address or token, ends requests in flight as InDoubt. Only for messages that
  /// may be sent twice.
  void give_up();
  /// Call before each request. True: address or token changed; earlier answers came from the old endpoint.
  bool turns();

  bool has_token() const { return connection_.has_value(); }
  /// "10.100.1.200:8000"
  const std::string& address() const { return address_; }
  /// Requires has_token(), and !busy() or can_go_ahead(). `content_type` is empty without a body.
  /// `is_on_trial`: this message failed alone before, so a rejection says nothing about the endpoint.
  void send(icd::Uri uri, std::string_view content_type, icd::ChunkedBytes body,
            std::function<void(uplink::Outcome)> done, loop::Instant last_byte_not_before = {},
            bool is_on_trial = false);
  bool busy() const { return !under_way_.empty(); }
  /// Resets the only request in flight. Its `done` is not called.
  void give_way();
  /// Prepares for a request ahead of the answer to the first.
  void preconnect() {
    if (!next_ && connection_) connection_->preconnect();
  }
  bool is_serial() const { return connection_ && connection_->is_serial(); }
  /// False: the Command Post serves one connection at a time, and serves one.
  bool is_free() const { return !connection_ || connection_->is_free(); }
  /// Requires has_token(). Call before each send(). False: `turn_came` will be called.
  bool claim_turn(bool goes_first = false) { return connection_->claim_turn(goes_first); }
  /// True if a second request can go ahead. False before a change of the way.
  bool can_go_ahead() const { return !next_ && connection_ && connection_->is_ready(); }
  /// uplink::Connections::has_arrived()
  std::optional<uplink::SendTimes> has_arrived() const;
  bool is_connected() const { return connection_ && connection_->is_connected(); }
  void retry_now() {
    if (connection_) connection_->retry_now();
  }
  void keep_warm() {
    keeps_warm_ = true;
    if (connection_) connection_->keep_warm();
  }

  /// Why there is no good answer or no connection; or "".
  std::string trouble() const;
  const LastAnswer& last() const { return last_; }
  /// True if the last status was a 2xx web page in place of a status.
  bool has_page_for_status() const { return has_page_; }
  /// True if the next status tries the other form of the path.
  bool is_trial_due() const { return is_trial_due_; }
  /// 0 without a connection.
  std::uint64_t delivers() const { return connection_ ? connection_->delivers() : 0; }
  /// Bytes of the last request that the kernel has accepted.
  std::size_t sent_bytes() const { return connection_ ? connection_->sent_bytes() : 0; }
  /// Bytes of all bodies that the kernel has accepted.
  std::uint64_t bytes_sent() const { return finished_bytes_ + (connection_ ? connection_->sent_bytes() : 0); }

 private:
  struct InFlightRequest {
    loop::Instant sent_at;
    icd::Uri uri;
    std::size_t bytes;  // of its body
    bool has_slash;
    bool is_trial;  // of the other form of the path
    bool is_on_trial;
    std::function<void(uplink::Outcome)> done;
  };
  void set_access(EndpointAccess way);
  bool leads_elsewhere(const EndpointAccess& way) const;
  void on_ended(const std::shared_ptr<InFlightRequest>& request, uplink::Outcome outcome);
  void learn_path(const InFlightRequest& request, const uplink::Outcome& outcome);

  loop::Loop& loop_;
  uplink::Servers& servers_;
  const char* name_;
  std::function<void()> turn_came_;
  std::string address_;
  std::optional<icd::BearerToken> token_;
  std::optional<uplink::Connections> connection_;
  std::chrono::milliseconds answer_within_{};
  bool keeps_warm_ = false;
  bool was_serial_ = false;
  bool wants_slash_ = false;                  // at the end of each path
  std::optional<bool> reports_want_slash_{};  // nullopt: as wants_slash_
  bool has_page_ = false;
  bool is_trial_due_ = false;  // for the next status
  std::optional<EndpointAccess> next_;
  std::vector<std::shared_ptr<InFlightRequest>> under_way_;  // at most two, oldest first
  std::uint64_t finished_bytes_ = 0;
  LastAnswer last_;
};

/// Maps are paced within the link's budget.
EndpointAccess access_to_scoring(const settings::CommandPost& command_post,
                                 std::optional<icd::BearerToken> token);
EndpointAccess access_to_mapping(const settings::CommandPost& command_post,
                                 std::optional<icd::BearerToken> token, std::uint64_t bytes_per_second = 0);
uplink::Endpoint endpoint_of(const settings::CommandPost& command_post, const settings::Address& address,
                             std::uint64_t bytes_per_second);

/// "10.100.1.200:8000"
std::string address_text(const settings::Address& address);

}  // namespace adit::forward
