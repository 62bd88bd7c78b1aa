#pragma once

#include <cstdint>
#include <expected>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "intake/server.hpp"
#include "loop/file_descriptor.hpp"

struct sockaddr;

namespace adit::intake {

/// Adds an accepted connection `fd`. `peer` is its address, of `size` bytes. The callee owns `fd`.
using Admit = std::function<void(int fd, const sockaddr* peer, unsigned size)>;

/// Accepts the connections of the socket `listening` in place of libmicrohttpd. The returned object gives
/// each connection to `admit` while it lives. Null: libmicrohttpd accepts them itself.
std::shared_ptr<void> accept_instead(int listening, Admit admit);

/// Opens a non-blocking socket that listens as `listen` asks. The error is a sentence. The kernel closes an
/// accepted connection if its peer does not answer for `listen.idle`, because a pulled cable sends no FIN.
std::expected<loop::FileDescriptor, std::string> open_listen_socket(const Listen& listen);

/// Sets the options of open_listen_socket() on a listening socket that another process opened.
std::expected<void, std::string> adopt_listen_socket(int fd, const Listen& listen);

/// The address at which a socket listens.
struct ListenAddress {
  std::string address = "";  // "::": each IPv6 address, and each IPv4 address unless only_v6
  std::uint16_t port = 0;
  std::string interface = "";  // "": each interface
  bool only_v6 = false;
};

/// The error says why `fd` is no listening TCP socket over IPv4 or IPv6.
std::expected<ListenAddress, std::string> bound_at(int fd);

/// True if its interface was removed. Clients cannot reach it, even if a new interface has the same name.
bool is_orphaned(int fd);

/// True if connections to `listen` reach the socket. If `listen` names no interface, the socket may have any.
bool covers(const ListenAddress& bound, const Listen& listen);

/// The port of a bound socket; 0 on an error.
std::uint16_t port_of(int fd);

/// True for an address of address_text() that only programs of this machine can use.
inline bool is_loopback(std::string_view address) {
  return address.starts_with("127.") || address == "::1";
}

/// The address without its port. An IPv4 address mapped into IPv6 (RFC 4291 2.5.5.2) is shown as IPv4.
std::string address_text(const sockaddr* address);

/// The local address of a socket; "" on an error.
std::string local_address(int fd);

}  // namespace adit::intake
