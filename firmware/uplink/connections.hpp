#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "uplink/connection.hpp"

namespace adit::uplink {

/// A connection to the Command Post, and at times a second one, on which a request goes ahead: it begins once
/// the one before it has arrived, and does not wait for its answer.
///
/// For the sake of servers that serve one connection at a time there are two no longer than that takes: the
/// second one is made for a request (get_ready()), and as soon as one of the two is answered, its connection
/// ends, or that on which nothing is under way. Such a server goes on with the other one then, and its
/// silence counts only from then on (Request::goes_ahead).
class Connections {
 public:
  Connections(loop::Loop& loop, Endpoint endpoint, icd::BearerToken token);

  void keep_warm() { first_.keep_warm(); }
  void hurry();

  /// Requires !busy() or is_ready(). `done` as in Connection::send().
  void send(Request request, std::function<void(Outcome)> done);
  bool busy() const { return first_.busy() || (second_ && second_->busy()); }

  /// Connection::give_up() of the request under way, if there is one.
  void give_up() {
    if (busy()) latest_->give_up();
  }

  /// Makes a connection for the next request, if one is under way: tries it once for each.
  void get_ready();
  /// Whether one request is under way, and a connection for the next one is open.
  bool is_ready() const;
  /// When the only request that is under way left, once all of it has arrived.
  std::optional<Sent> has_arrived() const;

  bool connected() const { return first_.connected() || (second_ && second_->connected()); }
  /// These as in Connection, of the one on which a request was sent last.
  const std::string& trouble() const { return latest_->trouble(); }
  std::size_t sent_bytes() const { return latest_->sent_bytes(); }
  std::uint64_t delivers() const { return first_.delivers(); }

 private:
  const Connection* the_busy_one() const;
  Connection* other_than(const Connection& one);
  Connection& one_for_the_next();
  void ended(Connection& one);

  Connection first_;
  std::unique_ptr<Connection> second_;  // null until it was needed
  Connection* latest_ = &first_;        // on which a request was sent last
  bool has_tried_ = false;              // to make the other one, since then
};

}  // namespace adit::uplink
