#include "codec/cell_press.hpp"

#include "icd/rules.hpp"

namespace adit::codec {

void CellPress::feed(std::span<const std::uint8_t> cells) {
  if (!checked_) return;
  checked_ = icd::check_cells(cells, fed_);
  fed_ += cells.size();
  gzipper_.feed(checked_ ? cells : cells.first(icd::sound_cells(cells)));
}

}  // namespace adit::codec
