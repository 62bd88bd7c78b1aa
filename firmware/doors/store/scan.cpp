#include "store/scan.hpp"

#include <algorithm>

namespace adit::store {

std::string FileHeader::written() const {
  std::string body;
  for (const std::uint64_t value : {version, number, salt, base, size}) put_number(body, value, 8);
  return body;
}

/// A later version may append numbers.
std::optional<FileHeader> FileHeader::parse(std::string_view body) {
  if (body.size() < 5 * 8) return std::nullopt;
  const auto value = [&body](std::size_t place) { return number_at(body, place * 8, 8); };
  return FileHeader{
      .version = value(0), .number = value(1), .salt = value(2), .base = value(3), .size = value(4)};
}

Scan scan(const FileName& name, std::string_view bytes, const Layout& layout) {
  Scan scan{.name = name, .size = bytes.size()};
  std::uint64_t newest = 0;
  for (std::size_t offset = 0; offset < bytes.size();) {
    const auto parsed = parse(bytes, offset, name.salt);
    if (!parsed) {
      offset = next_candidate(bytes, offset + 1, layout);
      continue;
    }
    const std::size_t room = room_of(parsed->frame.body.size(), layout);
    const std::size_t first = offset - std::min(offset, parsed->copy * room);
    offset += room;
    scan.process = std::max(scan.process, parsed->frame.process);
    if (parsed->frame.process < newest) continue;
    newest = parsed->frame.process;
    if (first == 0 && parsed->frame.kind == kFileBegins) {
      scan.header = FileHeader::parse(parsed->frame.body);
      scan.begin = Scan::Found{parsed->frame, first, parsed->copy + (scan.begin ? 1u : 0u)};
    } else if (!scan.frames.empty() && scan.frames.back().offset == first) {
      ++scan.frames.back().good;
    } else {
      scan.frames.push_back({parsed->frame, first, 1});
    }
  }
  return scan;
}

bool is_whole_snapshot(const Scan& scan) {
  if (!scan.header || scan.frames.empty() || scan.frames.back().frame.kind != kSnapshotEnds) return false;
  std::uint64_t next = 1;
  return std::ranges::all_of(scan.frames,
                             [&next](const Scan::Found& found) { return found.frame.sequence == next++; });
}

}  // namespace adit::store
