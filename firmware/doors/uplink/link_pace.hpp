#pragma once

#include <cstdint>
#include <optional>

#include "loop/loop.hpp"
#include "pace/delivery.hpp"

namespace adit::uplink {

/// Keeps the pace of a connection's socket at the rate that the link delivers.
class LinkPace {
 public:
  /// `most`: bytes per second; 0: not paced.
  explicit LinkPace(std::uint64_t most) {
    if (most > 0) delivery_.emplace(static_cast<double>(most));
  }

  /// Call this when the first bytes of a request have just been written to `fd`.
  void begins(int fd, loop::Instant now);
  /// Call this before more bytes are written, and every kLook.
  void goes_on(int fd, loop::Instant now);
  static constexpr loop::Duration kLook = pace::Delivery::kInterval / 2;

  /// Bytes per second that the link delivers, as measured; 0: not paced.
  std::uint64_t delivers() const;

 private:
  void tell(int fd);

  std::optional<pace::Delivery> delivery_;
  std::uint64_t told_ = 0;  // the pace that the socket has
};

}  // namespace adit::uplink
