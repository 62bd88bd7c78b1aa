#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "store/values.hpp"

namespace adit::store {

/// Largest body of a record, in bytes.
inline constexpr std::size_t kMostBody = 16u << 20;
/// Kinds of the log's own frames. Users' kinds are 1 to 126, and these with kMustUnderstand.
inline constexpr std::uint8_t kFileBegins = 0, kSnapshotEnds = 127;
/// Flag of a kind: a version that does not know the kind must not use the log.
inline constexpr std::uint8_t kMustUnderstand = 0x80;

/// Placement of frames in a file.
struct Layout {
  std::size_t align = 8;   // frames begin at multiples of it
  std::size_t copies = 1;  // adjacent copies of each frame: 1 or 2
};
/// On disk. A power cut tears whole sectors, so two frames never share a sector.
inline constexpr Layout kOnDisk{4096, 2};
/// In memory, where only a kill interrupts a write.
inline constexpr Layout kInMemory{8, 1};

/// A record in a file (README.md, "A frame").
struct Frame {
  std::uint8_t kind = 0;
  std::uint64_t sequence = 0;  // of the record in the log: 1, 2, 3 ...
  std::uint64_t process = 0;   // of the writing process, higher than all before
  std::uint64_t durable = 0;   // highest sequence number synced when the frame was written
  std::string_view body = {};
};

/// Bytes from the start of a copy to the next start.
std::size_t room_of(std::size_t body, const Layout& layout);

/// All copies of a frame at `offset` of the file with this salt.
std::string written(const Frame& frame, const Layout& layout, std::uint64_t salt, std::size_t offset);

struct Parsed {
  Frame frame;       // its body refers to the file's bytes
  std::size_t copy;  // 0 or 1
};
/// The frame at `offset`, or std::nullopt if it is absent or damaged.
std::optional<Parsed> parse(std::string_view file, std::size_t offset, std::uint64_t salt);

/// The first place for a frame from `offset` on, a multiple of layout.align; the file's size if there is
/// none.
std::size_t next_candidate(std::string_view file, std::size_t offset, const Layout& layout);

/// A file with one value, its kMembers in a frame with salt 0: no part of it comes from a peer.
template <class Of>
std::string file_of(const Of& value, const Layout& layout) {
  const std::string body = bytes_of(value);
  return written({.kind = 1, .body = body}, layout, 0, 0);
}
/// The value of file_of() from the copy at `offset`, or std::nullopt if the copy is absent or damaged. A
/// later version may have added members.
template <class Of>
std::optional<Of> value_in(std::string_view file, std::size_t offset = 0) {
  const auto parsed = parse(file, offset, 0);
  if (!parsed || parsed->frame.kind != 1) return std::nullopt;
  Reader take(parsed->frame.body);
  const Of value = take.read<Of>();
  return take.ok() ? std::optional(value) : std::nullopt;
}

/// Appends `number` in `bytes` bytes, little-endian.
void put_number(std::string& out, std::uint64_t number, std::size_t bytes);
/// The little-endian number of `size` bytes at `at`, which must exist.
std::uint64_t number_at(std::string_view bytes, std::size_t at, std::size_t size);

}  // namespace adit::store
