#include "gateway/file_return.hpp"

#include <memory>
#include <utility>

namespace adit::gateway {

FileReturn::FileReturn(loop::Loop& loop, loop::Writer& writer, std::function<bool()> can_be_read,
                       std::chrono::seconds rest, std::function<void()> is_back)
    : loop_(loop),
      writer_(writer),
      can_be_read_(std::move(can_be_read)),
      rest_(rest),
      is_back_(std::move(is_back)),
      timer_(loop.timer([this] { look(); })) {
  timer_.call_at(loop_.now() + rest_);
}

void FileReturn::look() {
  const auto can = std::make_shared<bool>(false);
  writer_.submit([can, can_be_read = can_be_read_] { *can = can_be_read(); },
                 [this, can] {
                   if (*can) return is_back_();
                   timer_.call_at(loop_.now() + rest_);
                 });
}

}  // namespace adit::gateway
