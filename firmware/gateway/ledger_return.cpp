#include "gateway/ledger_return.hpp"

#include <memory>
#include <utility>

namespace adit::gateway {

LedgerReturn::LedgerReturn(loop::Loop& loop, loop::Writer& writer, std::function<bool()> can_be_opened,
                           std::chrono::seconds rest, std::function<void()> is_back)
    : loop_(loop),
      writer_(writer),
      can_be_opened_(std::move(can_be_opened)),
      rest_(rest),
      is_back_(std::move(is_back)),
      timer_(loop.timer([this] { look(); })) {
  timer_.call_at(loop_.now() + rest_);
}

void LedgerReturn::look() {
  const auto can = std::make_shared<bool>(false);
  writer_.submit([can, can_be_opened = can_be_opened_] { *can = can_be_opened(); },
                 [this, can] { looked(*can); }, [this] { looked(false); });
}

void LedgerReturn::looked(bool can_be_opened) {
  if (can_be_opened) return is_back_();
  timer_.call_at(loop_.now() + rest_);
}

}  // namespace adit::gateway
