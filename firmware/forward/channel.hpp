#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "icd/uri.hpp"
#include "loop/loop.hpp"
#include "settings/settings.hpp"
#include "uplink/connections.hpp"

namespace adit::forward {

/// The way to an endpoint of the Command Post.
struct Way {
  uplink::Endpoint endpoint;
  std::optional<icd::BearerToken> token;
  std::chrono::milliseconds answer_within;
};

/// A connection to an endpoint of the Command Post, and its state: one request at a time, or a second one
/// that goes ahead (uplink::Connections). Without a token it is not opened.
///
/// If an answer redirects to the same path with a slash at its end, each later path has one, until such a
/// path is unknown there. It sends nothing again itself, and it does not learn from a report.
class Channel {
 public:
  /// `name`: of the endpoint, "scoring" or "mapping".
  Channel(loop::Loop& loop, const char* name, Way way);

  /// Leads there, by a new connection, once no request is under way.
  void lead_to(Way way) { next_ = std::move(way); }
  /// If that is another place, ends what is under way now, in doubt: for messages that may be sent again.
  void give_up();
  /// To be asked before each request. True: from this call on it leads to another address, or has another
  /// token; what was heard before came from the other place. Another way to the same place gives false.
  bool turns();

  bool has_token() const { return connection_.has_value(); }
  /// Where it leads: "10.100.1.200:8000"
  const std::string& address() const { return address_; }
  /// Requires has_token(), and !busy() or can_go_ahead(). `content_type` is empty without a body;
  /// `last_byte_not_before` as in uplink::Request.
  void send(icd::Uri uri, std::string_view content_type, icd::ChunkedBytes body,
            std::function<void(uplink::Outcome)> done, loop::Instant last_byte_not_before = {});
  bool busy() const { return !under_way_.empty(); }
  /// Ends the only request under way: its connection is reset, its `done` is never called, and its answer is
  /// never read. The next request goes by a new connection.
  void give_way();
  /// Gets ready to send a request ahead of the answer to the only one that is under way.
  void get_ready();
  /// It is ready to. Not where it is to lead elsewhere: then what is under way is the last.
  bool can_go_ahead() const { return !next_ && connection_ && connection_->is_ready(); }
  /// uplink::Connections::has_arrived()
  std::optional<uplink::Sent> has_arrived() const;
  bool connected() const { return connection_ && connection_->connected(); }
  /// uplink::Connection::hurry()
  void hurry() {
    if (connection_) connection_->hurry();
  }
  void keep_warm() {
    keeps_warm_ = true;
    if (connection_) connection_->keep_warm();
  }

  /// Why the last request failed or was refused, or why there is no connection; "" if all is well.
  std::string trouble() const;
  int last_status() const { return last_status_; }
  std::optional<double> answer_ms() const { return answer_ms_; }
  /// Whether the last answer was one that no Command Post gives, and how many such came.
  bool is_foreign() const { return foreign_now_; }
  std::uint64_t foreign() const { return foreign_; }
  /// How many requests have ended, in any way.
  std::uint64_t ended() const { return ended_; }
  /// How many answers were 429.
  std::uint64_t throttled() const { return throttled_; }
  /// The time of day by the Date of the last answer that had one, in seconds since 1970, now; nothing: no
  /// answer that is the Command Post's own for certain had one.
  std::optional<double> time_there() const;
  /// When last_status() was heard.
  loop::Instant heard() const { return heard_; }
  /// uplink::Connection::delivers(); 0 where there is no connection.
  std::uint64_t delivers() const { return connection_ ? connection_->delivers() : 0; }
  /// Bytes of the request that was sent last that the kernel has taken.
  std::size_t sent_of_it() const { return connection_ ? connection_->sent_bytes() : 0; }
  /// All bytes of bodies that were handed to the kernel, those under way included.
  std::uint64_t bytes_sent() const { return finished_bytes_ + (connection_ ? connection_->sent_bytes() : 0); }

 private:
  struct UnderWay {
    loop::Instant sent_at;
    icd::Uri uri;
    bool has_slash;
    std::function<void(uplink::Outcome)> done;
  };
  void take(Way way);
  bool leads_elsewhere(const Way& way) const;
  void ended(const std::shared_ptr<UnderWay>& request, uplink::Outcome outcome);
  void note(const UnderWay& request, const uplink::Outcome& outcome);
  void learn_path(const UnderWay& request, const uplink::Answered& answered);

  loop::Loop& loop_;
  const char* name_;
  std::string address_;
  std::optional<icd::BearerToken> token_;
  std::optional<uplink::Connections> connection_;
  std::chrono::milliseconds answer_within_{};
  bool keeps_warm_ = false;
  bool wants_slash_ = false;  // the place that it leads to, at the end of each path
  std::optional<Way> next_;
  std::vector<std::shared_ptr<UnderWay>> under_way_;  // at most two; the first was sent first
  loop::Instant heard_{};
  std::uint64_t finished_bytes_ = 0, ended_ = 0, throttled_ = 0, foreign_ = 0;
  bool foreign_now_ = false;
  int last_status_ = 0;
  std::optional<double> answer_ms_;
  std::optional<double> date_;  // seconds since 1970
  loop::Instant dated_{};
  std::string trouble_;
};

/// The ways by the settings; maps are paced within the link's budget.
Way way_to_scoring(const settings::CommandPost& command_post, std::optional<icd::BearerToken> token);
Way way_to_mapping(const settings::CommandPost& command_post, std::optional<icd::BearerToken> token,
                   std::uint64_t bytes_per_second = 0);
/// Where an endpoint is by the settings.
uplink::Endpoint endpoint_of(const settings::CommandPost& command_post, const settings::Address& address,
                             std::uint64_t bytes_per_second);

/// "10.100.1.200:8000"
std::string address_text(const settings::Address& address);

/// Why an outcome is no answer, or what the Command Post said in it.
std::string sentence_of(const uplink::Outcome& outcome);

}  // namespace adit::forward
