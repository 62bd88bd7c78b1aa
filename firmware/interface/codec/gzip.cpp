#include "codec/gzip.hpp"

#include <libdeflate.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <memory>
#include <new>
#include <ranges>
#include <utility>

#include "icd/require.hpp"
#include "icd/sentence.hpp"
#include "icd/try.hpp"

namespace adit::codec {

namespace {

constexpr std::size_t kPiece = icd::ChunkedBytes::kChunk;
constexpr int kLevel = 6;
constexpr int kGzip = MAX_WBITS + 16;  // zlib: only a gzip wrapper
constexpr int kRaw = -MAX_WBITS;       // no wrapper
constexpr int kMemoryLevel = 8;        // zlib's default

/// zlib's pointer is not const, but zlib only reads.
Bytef* to_zlib(std::span<const std::uint8_t> bytes) {
  return const_cast<Bytef*>(bytes.data());
}

/// zlib can fail to start only for lack of memory.
void require_started(int code) {
  if (code != Z_OK) throw std::bad_alloc();
}

class Inflater {
 public:
  Inflater() { require_started(inflateInit2(&stream_, kGzip)); }
  ~Inflater() { inflateEnd(&stream_); }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;

  z_stream& stream() { return stream_; }

 private:
  z_stream stream_{};
};

icd::Refusal damage_refusal(std::string_view path, const char* why, std::size_t after) {
  if (after > 0)
    return icd::unprocessable(path, ": expected only gzip members after a gzip member, got ", after,
                              " other bytes")
        .error();
  return icd::unprocessable(path, ": expected a gzip member, got ", why ? why : "damaged data").error();
}

icd::Refusal too_large(std::string_view path, std::size_t most) {
  return {icd::Status::ContentTooLarge, icd::sentence(path, ": expected at most ", most, " bytes, got more")};
}

}  // namespace

struct Gzipper::Stream {
  explicit Stream(GzipStrategy strategy) {
    const int zlibs = strategy == GzipStrategy::Runs ? Z_RLE : Z_DEFAULT_STRATEGY;
    require_started(deflateInit2(&zlib, kLevel, Z_DEFLATED, kRaw, kMemoryLevel, zlibs));
  }
  ~Stream() { deflateEnd(&zlib); }
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;

  z_stream zlib{};
  std::uint32_t checksum = 0;  // by libdeflate, because zlib's would take a fifth of the time of Runs
  std::uint32_t size = 0;      // modulo 2^32
};

Gzipper::Gzipper(GzipStrategy strategy) : stream_(std::make_unique<Stream>(strategy)), piece_(kPiece) {
  constexpr std::array<std::uint8_t, 10> kHead = {0x1f, 0x8b, 8, 0, 0, 0, 0, 0, 0, 3};  // deflate; Unix
  std::ranges::copy(kHead, piece_.begin());
  made_ = kHead.size();
}
Gzipper::~Gzipper() = default;
Gzipper::Gzipper(Gzipper&&) noexcept = default;
Gzipper& Gzipper::operator=(Gzipper&&) noexcept = default;

void Gzipper::deflate_with(int flush) {
  z_stream& zlib = stream_->zlib;
  bool full = true;
  while (full) {
    if (made_ == kPiece) give_piece();
    zlib.next_out = piece_.data() + made_;
    zlib.avail_out = static_cast<uInt>(kPiece - made_);
    deflate(&zlib, flush);  // cannot fail: the stream is valid and has room
    full = zlib.avail_out == 0;
    made_ = kPiece - zlib.avail_out;
  }
}

void Gzipper::give_piece() {
  member_.append(std::move(piece_));
  piece_ = std::vector<std::uint8_t>(kPiece);
  made_ = 0;
}

void Gzipper::feed(std::span<const std::uint8_t> bytes) {
  constexpr std::size_t kMostAtOnce = 1U << 30;  // zlib counts in 32 bits
  while (!bytes.empty()) {
    const auto part = bytes.first(std::min(bytes.size(), kMostAtOnce));
    stream_->zlib.next_in = to_zlib(part);
    stream_->zlib.avail_in = static_cast<uInt>(part.size());
    deflate_with(Z_NO_FLUSH);
    stream_->checksum = libdeflate_crc32(stream_->checksum, part.data(), part.size());
    stream_->size += static_cast<std::uint32_t>(part.size());
    bytes = bytes.subspan(part.size());
  }
}

icd::ChunkedBytes Gzipper::finish() {
  deflate_with(Z_FINISH);
  member_.append(std::span(piece_).first(made_));  // a copy, so that a small member takes little memory
  std::array<std::uint8_t, 8> tail{};
  for (std::size_t i = 0; i < tail.size(); ++i) {
    tail[i] = static_cast<std::uint8_t>((i < 4 ? stream_->checksum : stream_->size) >> 8 * (i % 4));
  }
  member_.append(tail);
  return std::move(member_);
}

icd::ChunkedBytes gzip(icd::ChunkedBytes bytes, GzipStrategy strategy) {
  Gzipper gzipper(strategy);
  while (!bytes.empty()) gzipper.feed(*bytes.pop_front());
  return gzipper.finish();
}

std::size_t claimed_size(const icd::ChunkedBytes& bytes) {
  constexpr std::size_t kSize = 4;
  if (bytes.size() < kSize) return 0;
  std::size_t claimed = 0;
  std::size_t left = kSize;  // the last byte is the highest
  for (const auto& chunk : std::views::reverse(bytes.chunks())) {
    for (const std::uint8_t byte : std::views::reverse(*chunk) | std::views::take(left)) {
      claimed = claimed << 8 | byte;
      --left;
    }
    if (left == 0) break;
  }
  return claimed;
}

icd::Checked<Gunzipped> gunzip(icd::ChunkedBytes bytes, std::size_t most, std::string_view path,
                               const Sink& sink) {
  Inflater inflater;
  z_stream& zlib = inflater.stream();
  std::vector<std::uint8_t> piece(kPiece);
  Gunzipped all;
  bool ended = false;
  std::size_t after = 0;  // bytes after the last whole member
  while (!bytes.empty()) {
    const auto chunk = bytes.pop_front();
    zlib.next_in = to_zlib(*chunk);
    zlib.avail_in = static_cast<uInt>(chunk->size());
    while (zlib.avail_in > 0 || (zlib.avail_out == 0 && !ended)) {
      if (ended) {
        after = zlib.avail_in + bytes.size();
        inflateReset(&zlib);
      }
      zlib.next_out = piece.data();
      zlib.avail_out = static_cast<uInt>(piece.size());
      const int code = inflate(&zlib, Z_NO_FLUSH);
      ended = code == Z_STREAM_END;
      if (code != Z_OK && code != Z_BUF_ERROR && !ended)
        return std::unexpected(damage_refusal(path, zlib.msg, after));
      if (ended) ++all.members;
      const std::size_t made = piece.size() - zlib.avail_out;
      all.size += made;
      if (all.size > most) return std::unexpected(too_large(path, most));
      if (made == 0) continue;
      ADIT_TRY(sink({piece.data(), made}));
    }
  }
  if (!ended) return std::unexpected(damage_refusal(path, "one that is cut short", after));
  return all;
}

namespace {

struct Deleter {
  void operator()(std::uint8_t* memory) const { std::free(memory); }
  void operator()(libdeflate_compressor* compressor) const { libdeflate_free_compressor(compressor); }
  void operator()(libdeflate_decompressor* decompressor) const { libdeflate_free_decompressor(decompressor); }
};
using Memory = std::unique_ptr<std::uint8_t, Deleter>;

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

std::optional<icd::ChunkedBytes> gzip(std::span<const std::uint8_t> bytes, int level, std::size_t most) {
  icd::require(level >= kFastestLevel && level <= kSmallestLevel);
  const std::unique_ptr<libdeflate_compressor, Deleter> compressor(libdeflate_alloc_compressor(level));
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

std::optional<std::vector<std::uint8_t>> gunzip(const icd::ChunkedBytes& member, std::size_t size) {
  const std::unique_ptr<libdeflate_decompressor, Deleter> decompressor(libdeflate_alloc_decompressor());
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

namespace {

icd::Checked<void> give_pieces(std::span<const std::uint8_t> bytes, const Sink& sink) {
  while (!bytes.empty()) {
    const auto piece = bytes.first(std::min(bytes.size(), icd::ChunkedBytes::kChunk));
    if (auto taken = sink(piece); !taken) return taken;
    bytes = bytes.subspan(piece.size());
  }
  return {};
}

}  // namespace

icd::Checked<void> for_each_piece(const icd::MapData& data, const Sink& sink) {
  if (data.compression == icd::Compression::None) {
    for (const auto& chunk : data.bytes.chunks()) {
      if (auto taken = give_pieces(*chunk, sink); !taken) return taken;
    }
    return {};
  }
  ADIT_TRY(gunzip(data.bytes, data.raw_size, "msg.data", sink));
  return {};
}

}  // namespace adit::codec
