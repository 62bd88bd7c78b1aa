#pragma once

#include <cstdint>
#include <optional>

#include "loop/loop.hpp"
#include "pace/delivery.hpp"

namespace adit::uplink {

/// Keeps the pace of a connection's socket at what the link delivers.
class LinkPace {
 public:
  /// Bytes a second at the most; 0: not paced.
  explicit LinkPace(std::uint64_t most) {
    if (most > 0) delivery_.emplace(static_cast<double>(most));
  }

  /// The first bytes of a request have just been given to `fd`.
  void begins(int fd, loop::Instant now);
  /// More of it is about to be given, or so much time is over since the last look.
  void goes_on(int fd, loop::Instant now);
  static constexpr loop::Duration kLook = pace::Delivery::kInterval / 2;

  /// Bytes a second that the link delivers of what it is given, as far as is known; 0: not paced.
  std::uint64_t delivers() const;

 private:
  void tell(int fd);

  std::optional<pace::Delivery> delivery_;
  std::uint64_t told_ = 0;  // the socket
};

}  // namespace adit::uplink
