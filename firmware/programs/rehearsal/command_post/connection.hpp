#pragma once

#include <poll.h>

#include <chrono>
#include <expected>
#include <optional>
#include <span>
#include <string>

#include "loop/file_descriptor.hpp"
#include "rehearsal/command_post/server.hpp"

namespace adit::rehearsal {

/// poll(2), again after a signal. `patience_ms` -1: for ever.
int poll_again(std::span<pollfd> waited, int patience_ms);

/// A TCP socket that listens on `address`; an error says why there is none.
std::expected<loop::FileDescriptor, std::string> listening_socket(const Address& address);

/// The address a socket is bound to.
std::optional<Address> local_address_of(int socket);

/// One connection of a client: reads requests and writes what was decided about each, one after the other.
class Connection {
 public:
  /// How it came to its end.
  enum class End {
    Closed,
    EndpointDies,  // a request killed it
  };

  /// `stop_event`: becomes readable when the connection is to end.
  Connection(loop::FileDescriptor socket, int stop_event, const WireManner& manner, const Decide& decide)
      : socket_(std::move(socket)), stop_event_(stop_event), manner_(manner), decide_(decide) {}

  End serve();

 private:
  enum class Arrival { Bytes, Closed, Late, Stopped };

  /// Nothing where there is no further request: closed, idle for too long, or stopped.
  std::optional<Request> read_request();
  bool write(const std::string& bytes);
  Arrival receive();
  /// Waits for so long, for ever without `patience`; gives whether the connection is to end instead.
  bool stopped_within(std::optional<std::chrono::milliseconds> patience) const;
  void end(After after);
  void reset();
  void close_gently();
  std::string local_address() const;

  loop::FileDescriptor socket_;
  const int stop_event_;
  const WireManner& manner_;
  const Decide& decide_;
  std::string received_;  // not yet parsed
};

}  // namespace adit::rehearsal
