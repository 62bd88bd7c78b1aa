#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "uplink/connection.hpp"
#include "uplink/server.hpp"

namespace adit::uplink {

/// A connection to the Command Post, and sometimes a second one. A request on the second one goes ahead: it
/// is sent when the earlier request has arrived, and before its answer.
///
/// Some servers serve one connection at a time, so there are two connections no longer than necessary. The
/// second one is made for a request (get_ready()). When a request ends, its connection is closed if the other
/// one is busy; otherwise the other one is closed. Such a server then reads the other connection, and its
/// silence counts only from then on (Request::goes_ahead).
class Connections {
 public:
  /// `turn_came`: as Server::Turn::came.
  Connections(loop::Loop& loop, Endpoint endpoint, icd::BearerToken token, std::shared_ptr<Server> server,
              std::function<void()> turn_came);
  ~Connections() { server_->remove(turn_); }
  Connections(const Connections&) = delete;
  Connections& operator=(const Connections&) = delete;

  void keep_warm() { first_.keep_warm(); }
  void hurry();

  /// Requires !busy() or is_ready(). `done`: as in Connection::send().
  void send(Request request, std::function<void(Outcome)> done);
  bool busy() const { return first_.busy() || (second_ && second_->busy()); }

  /// Connection::give_up() of the last request, if a request is in flight.
  void give_up() {
    if (busy()) latest_->give_up();
  }

  /// Opens a connection for the next request if one request is in flight. Tries once for each request.
  void get_ready();
  /// True if one request is in flight and a connection for the next one is open.
  bool is_ready() const;
  /// When the only request in flight left; nullopt until all of it has arrived.
  std::optional<Sent> has_arrived() const;

  /// The server gets one connection at a time, and no request ahead.
  bool is_serial() const { return server_->is_serial(); }
  /// Server::is_free()
  bool is_free() const { return server_->is_free(); }
  /// Server::claim(). Call before each send().
  bool claim_turn(bool goes_first) { return server_->claim(turn_, goes_first); }
  /// True also between two requests to a serial server.
  bool connected() const {
    return first_.connected() || (second_ && second_->connected()) || (is_serial() && trouble().empty());
  }
  /// As in Connection, for the connection of the last request.
  const std::string& trouble() const { return latest_->trouble(); }
  std::size_t sent_bytes() const { return latest_->sent_bytes(); }
  std::uint64_t delivers() const { return first_.delivers(); }

 private:
  const Connection* the_busy_one() const;
  Connection* other_than(const Connection& one);
  Connection& one_for_the_next();
  void ended(Connection& one);

  const std::shared_ptr<Server> server_;
  Server::Turn turn_;
  Connection first_;
  std::unique_ptr<Connection> second_;  // null until it is needed
  Connection* latest_ = &first_;        // the connection of the last request
  bool has_tried_ = false;              // get_ready() has tried since the last request
};

}  // namespace adit::uplink
