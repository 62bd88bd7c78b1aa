#pragma once

#include <poll.h>

#include <expected>
#include <optional>
#include <span>
#include <string>

#include "loop/file_descriptor.hpp"
#include "rehearsal/command_post/address.hpp"

namespace adit::rehearsal {

/// poll(2), again after a signal. `patience_ms` -1: for ever.
int poll_again(std::span<pollfd> waited, int patience_ms);

/// A TCP socket that listens on `address`; an error says why there is none.
std::expected<loop::FileDescriptor, std::string> listening_socket(const Address& address);

/// The address a socket is bound to.
std::optional<Address> local_address_of(int socket);

}  // namespace adit::rehearsal
