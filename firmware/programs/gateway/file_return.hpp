#pragma once

#include <algorithm>
#include <chrono>
#include <functional>
#include <memory>
#include <utility>

#include "loop/loop.hpp"
#include "loop/workers.hpp"

namespace adit::gateway {

/// Tries unreadable files again after each `rest`: the ledger, the settings, messages or other saved files.
/// Calls `is_back` once when all can be read.
class FileReturn {
 public:
  static constexpr std::chrono::seconds kRest{5}, kLongestRest{300};

  /// `writer` runs `can_be_read`, which waits for the disk. `loop` and `writer` outlive this.
  FileReturn(loop::Loop& loop, loop::Writer& writer, std::function<bool()> can_be_read,
             std::chrono::seconds rest, std::function<void()> is_back)
      : loop_(loop),
        writer_(writer),
        can_be_read_(std::move(can_be_read)),
        rest_(rest),
        is_back_(std::move(is_back)),
        timer_(loop.timer([this] { check(); })) {
    timer_.call_at(loop_.now() + rest_);
  }

 private:
  void check() {
    const auto can = std::make_shared<bool>(false);
    writer_.submit([can, can_be_read = can_be_read_] { *can = can_be_read(); },
                   [this, can] {
                     if (*can) return is_back_();
                     timer_.call_at(loop_.now() + rest_);
                   });
  }

  loop::Loop& loop_;
  loop::Writer& writer_;
  const std::function<bool()> can_be_read_;
  const std::chrono::seconds rest_;
  const std::function<void()> is_back_;
  loop::Source timer_;
};

/// The next rest, if the files were not readable after all. Each restart of the gateway rejects clients.
inline std::chrono::seconds longer(std::chrono::seconds rest) {
  return std::min(2 * rest, FileReturn::kLongestRest);
}

}  // namespace adit::gateway
