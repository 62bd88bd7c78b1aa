#pragma once

#include <functional>
#include <memory>

struct sockaddr;

namespace adit::intake {

/// Takes in a connection of the peer at that address, of `size` bytes; the descriptor is then the taker's.
using Admit = std::function<void(int fd, const sockaddr* peer, unsigned size)>;

/// Who takes the connections to `listening` out of its queue: null: libmicrohttpd itself does. Otherwise
/// somebody who gives each to `admit`, until what is returned is let go of.
std::shared_ptr<void> accept_instead(int listening, Admit admit);

}  // namespace adit::intake
