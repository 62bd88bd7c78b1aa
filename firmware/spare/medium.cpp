#include "spare/medium.hpp"

#include <algorithm>

#include "icd/sentence.hpp"

namespace adit::spare {

std::expected<Medium, std::string> medium_for(std::span<const Medium> media, std::uint64_t size) {
  if (media.empty()) return std::unexpected("there is no stick in the box");
  if (std::ranges::any_of(media, [&media](const Medium& each) { return each.disk != media.front().disk; }))
    return std::unexpected("there is more than one stick in the box: leave only the one for the export");
  const Medium* best = nullptr;
  for (const Medium& each : media) {
    if (each.is_mounted && (best == nullptr || each.room > best->room)) best = &each;
  }
  if (best == nullptr)
    return std::unexpected("the box cannot read the stick's file system: expected FAT32 or ext4");
  if (best->is_write_protected) return std::unexpected("the stick is write-protected");
  if (best->room < size)
    return std::unexpected(
        icd::sentence("the stick has room for ", best->room, " bytes, but the export has ", size));
  return *best;
}

}  // namespace adit::spare
