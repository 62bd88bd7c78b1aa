#include "codec/gzip_whole.hpp"

#include <libdeflate.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <new>
#include <utility>

#include "icd/require.hpp"

namespace adit::codec {
namespace {

struct Freed {
  void operator()(std::uint8_t* memory) const { std::free(memory); }
  void operator()(libdeflate_compressor* compressor) const { libdeflate_free_compressor(compressor); }
};
using Memory = std::unique_ptr<std::uint8_t, Freed>;

/// Of malloc, so that what is not used of it goes back to the system without a copy.
Memory memory_of(std::size_t size) {
  Memory memory(static_cast<std::uint8_t*>(std::malloc(size)));
  if (!memory) throw std::bad_alloc();
  return memory;
}

Memory cut_to(Memory memory, std::size_t size) {
  auto* const cut = static_cast<std::uint8_t*>(std::realloc(memory.get(), size));
  if (cut == nullptr) return memory;
  (void)memory.release();
  return Memory(cut);
}

}  // namespace

std::optional<icd::ChunkedBytes> gzip_whole(std::span<const std::uint8_t> bytes, int level,
                                            std::size_t most) {
  icd::require(level >= kFastestLevel && level <= kSmallestLevel);
  const std::unique_ptr<libdeflate_compressor, Freed> compressor(libdeflate_alloc_compressor(level));
  if (!compressor) throw std::bad_alloc();
  const std::size_t room = std::min(most, libdeflate_gzip_compress_bound(compressor.get(), bytes.size()));
  if (room == 0) return std::nullopt;
  Memory memory = memory_of(room);
  const std::size_t size =
      libdeflate_gzip_compress(compressor.get(), bytes.data(), bytes.size(), memory.get(), room);
  if (size == 0) return std::nullopt;
  const std::shared_ptr<const std::uint8_t> owner = cut_to(std::move(memory), size);
  icd::ChunkedBytes member;
  member.append(owner, {owner.get(), size});
  return member;
}

}  // namespace adit::codec
