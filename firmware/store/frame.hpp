#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace adit::store {

/// The longest content of one record, in bytes.
inline constexpr std::size_t kMostBody = 16u << 20;
/// The kinds of the log's own frames. A user's kinds are 1 to 126, and these with kMustUnderstand.
inline constexpr std::uint8_t kFileBegins = 0, kSnapshotEnds = 127;
/// Set in a kind: a version that does not know the kind must not use the log.
inline constexpr std::uint8_t kMustUnderstand = 0x80;

/// How frames are placed in a file.
struct Layout {
  std::size_t align = 8;   // a frame begins at a multiple of it
  std::size_t copies = 1;  // of each frame, side by side: 1 or 2
};
/// On a disk: a power cut tears what is written by sectors, so no sector is shared by two frames.
inline constexpr Layout kOnDisk{4096, 2};
/// In memory, where only a kill ends a write.
inline constexpr Layout kInMemory{8, 1};

/// One record as it is in a file (README.md, "A frame").
struct Frame {
  std::uint8_t kind = 0;
  std::uint64_t sequence = 0;  // of the record: 1, 2, 3 ... in a log
  std::uint64_t process = 0;   // number of the process that wrote it: higher than any before
  std::uint64_t durable = 0;   // the highest sequence number that was synced when it was written
  std::string_view body = {};
};

/// Bytes from the begin of one copy to the begin of what follows.
std::size_t room_of(std::size_t body, const Layout& layout);

/// The bytes of all copies of a frame that begins at `offset` of the file with this salt.
std::string written(const Frame& frame, const Layout& layout, std::uint64_t salt, std::size_t offset);

struct Parsed {
  Frame frame;       // its body is a part of the file's bytes
  std::size_t copy;  // 0 or 1
};
/// The frame at `offset` of a file; nothing if there is none, or a byte of it is damaged.
std::optional<Parsed> parse(std::string_view file, std::size_t offset, std::uint64_t salt);

/// The first multiple of layout.align, at least `offset`, where a frame may begin; the file's size if none.
std::size_t next_candidate(std::string_view file, std::size_t offset, const Layout& layout);

/// Appends `number` in `bytes` bytes, little-endian.
void put_number(std::string& out, std::uint64_t number, std::size_t bytes);
/// The little-endian number of `size` bytes at `at`, which must be there.
std::uint64_t number_at(std::string_view bytes, std::size_t at, std::size_t size);

}  // namespace adit::store
