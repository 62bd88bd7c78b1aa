#pragma once

#include <cstdint>
#include <expected>
#include <string>

#include "intake/server.hpp"
#include "loop/file_descriptor.hpp"

struct sockaddr;

namespace adit::intake {

/// A non-blocking socket that listens as `listen` asks, or a sentence that says what failed. Connections
/// accepted from it are closed by the kernel where the other side stops answering for `listen.idle` (a pulled
/// cable sends no FIN).
std::expected<loop::FileDescriptor, std::string> open_listen_socket(const Listen& listen);

/// Makes a socket that somebody else opened, and that listens, as one of open_listen_socket().
std::expected<void, std::string> adopt_listen_socket(int fd, const Listen& listen);

/// Where a socket listens.
struct Bound {
  std::string address = "";  // "::": every address, of IPv4 as well unless only_v6
  std::uint16_t port = 0;
  std::string interface = "";  // "": any
  bool only_v6 = false;
};

/// An error says what it is instead of a TCP socket over IPv4 or IPv6 that listens.
std::expected<Bound, std::string> bound_at(int fd);

/// Whether it is bound to an interface that is gone: nobody reaches it any more, also once there is another
/// of that name.
bool is_deaf(int fd);

/// Whether what comes to `listen` comes to that socket. Where `listen` names no interface, the socket's will
/// do.
bool covers(const Bound& bound, const Listen& listen);

/// The port that a bound socket has.
std::uint16_t port_of(int fd);

/// The address without its port; an IPv4 address mapped into IPv6 (RFC 4291 2.5.5.2) is shown as IPv4.
std::string address_text(const sockaddr* address);

/// The address of this machine that a connection came to.
std::string local_address(int fd);

}  // namespace adit::intake
