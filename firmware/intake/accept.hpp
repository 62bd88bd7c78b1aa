#pragma once

#include <functional>
#include <memory>

struct sockaddr;

namespace adit::intake {

/// Takes in a connection of the peer at that address, of `size` bytes; the descriptor is then the taker's.
using Admit = std::function<void(int fd, const sockaddr* peer, unsigned size)>;

/// What takes the connections to `listening` out of its queue. Null: libmicrohttpd itself does. Otherwise the
/// object gives each of them to `admit` for as long as it lives.
std::shared_ptr<void> accept_instead(int listening, Admit admit);

}  // namespace adit::intake
