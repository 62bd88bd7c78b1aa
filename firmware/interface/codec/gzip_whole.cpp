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
  void operator()(libdeflate_decompressor* decompressor) const { libdeflate_free_decompressor(decompressor); }
};
using Memory = std::unique_ptr<std::uint8_t, Freed>;

/// From malloc, so that the unused part returns to the system without a copy.
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

std::optional<std::vector<std::uint8_t>> gunzip_whole(const icd::ChunkedBytes& member, std::size_t size) {
  const std::unique_ptr<libdeflate_decompressor, Freed> decompressor(libdeflate_alloc_decompressor());
  if (!decompressor) throw std::bad_alloc();
  std::vector<std::uint8_t> together, bytes(size);
  if (member.chunks().size() > 1) together = member.to_vector();
  const std::span<const std::uint8_t> all =
      member.chunks().size() == 1 ? *member.chunks().front() : std::span<const std::uint8_t>(together);
  std::size_t read = 0, made = 0;
  const libdeflate_result result = libdeflate_gzip_decompress_ex(decompressor.get(), all.data(), all.size(),
                                                                 bytes.data(), bytes.size(), &read, &made);
  if (result != LIBDEFLATE_SUCCESS || read != all.size() || made != size) return std::nullopt;
  return bytes;
}

}  // namespace adit::codec
