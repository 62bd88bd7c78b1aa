#pragma once

#include <functional>
#include <memory>

struct sockaddr;

namespace adit::intake {

/// Adds an accepted connection `fd`. `peer` is its address, of `size` bytes. The callee owns `fd`.
using Admit = std::function<void(int fd, const sockaddr* peer, unsigned size)>;

/// Accepts the connections of the socket `listening` in place of libmicrohttpd. The returned object gives
/// each connection to `admit` while it lives. Null: libmicrohttpd accepts them itself.
std::shared_ptr<void> accept_instead(int listening, Admit admit);

}  // namespace adit::intake
