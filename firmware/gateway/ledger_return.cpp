#include "gateway/ledger_return.hpp"

#include <memory>
#include <utility>

#include "ledger/ledger.hpp"

namespace adit::gateway {

LedgerReturn::LedgerReturn(loop::Loop& loop, loop::Writer& writer, std::string folder,
                           std::chrono::seconds rest, std::function<void()> is_back)
    : loop_(loop),
      writer_(writer),
      folder_(std::move(folder)),
      rest_(rest),
      is_back_(std::move(is_back)),
      timer_(loop.timer([this] { look(); })) {
  timer_.call_at(loop_.now() + rest_);
}

void LedgerReturn::look() {
  const auto can = std::make_shared<bool>(false);
  writer_.submit([can, folder = folder_] { *can = ledger::Ledger::can_be_opened(folder); },
                 [this, can] { looked(*can); }, [this] { looked(false); });
}

void LedgerReturn::looked(bool can_be_opened) {
  if (can_be_opened) return is_back_();
  timer_.call_at(loop_.now() + rest_);
}

}  // namespace adit::gateway
