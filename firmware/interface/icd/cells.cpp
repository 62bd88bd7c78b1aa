// Checks of the cells of a grid.
#include <algorithm>

#include "icd/map_update.hpp"
#include "icd/rules.hpp"
#include "icd/sentence.hpp"

namespace adit::icd {
namespace {

bool is_bad(std::uint8_t cell) {
  return cell > kMostOccupied && cell != kUnknownCell;
}

}  // namespace

std::size_t sound_cells(std::span<const std::uint8_t> cells) {
  std::uint8_t bad = 0;  // compilers vectorize this loop because it has no early exit
  for (const std::uint8_t cell : cells) bad |= static_cast<std::uint8_t>(is_bad(cell) ? 1 : 0);
  if (bad == 0) return cells.size();
  return static_cast<std::size_t>(std::ranges::find_if(cells, is_bad) - cells.begin());
}

Checked<void> check_cells(std::span<const std::uint8_t> cells, std::size_t first) {
  const std::size_t sound = sound_cells(cells);
  if (sound == cells.size()) return {};
  return unprocessable("msg.data[", first + sound, "]: expected 0 to 100 or 255, got ", +cells[sound]);
}

}  // namespace adit::icd
