#include "picture/tile.hpp"

#include <zlib.h>

#include <algorithm>
#include <new>

namespace adit::picture {
namespace {

constexpr int kMemory = 4;               // for zlib: runs are found without its large table
constexpr std::size_t kRow = kSide + 1;  // a row begins with the number of its filter (PNG 7.3); 0: none
constexpr std::uint8_t kIdat[] = {'I', 'D', 'A', 'T'};

void require(bool started) {
  if (!started) throw std::bad_alloc();  // zlib fails to start only if memory runs out
}

std::uint32_t crc_of(const std::vector<std::uint8_t>& deflated) {
  const auto crc = crc32(crc32(0, kIdat, sizeof kIdat), deflated.data(), static_cast<uInt>(deflated.size()));
  return static_cast<std::uint32_t>(crc);
}

}  // namespace

struct Packer::Streams {
  Streams() {
    // Only runs of one index: a third of level 4's time, and no more bytes for tiles of maps.
    require(deflateInit2(&out, Z_DEFAULT_COMPRESSION, Z_DEFLATED, MAX_WBITS, kMemory, Z_RLE) == Z_OK);
    require(inflateInit(&in) == Z_OK);
  }
  ~Streams() {
    deflateEnd(&out);
    inflateEnd(&in);
  }
  Streams(const Streams&) = delete;
  Streams& operator=(const Streams&) = delete;

  z_stream out{}, in{};
};

Packer::Packer() : streams_(std::make_unique<Streams>()), rows_(kRow * kSide) {
  made_.resize(deflateBound(&streams_->out, rows_.size()));
}
Packer::~Packer() = default;

bool Packer::read_rows(const PackedTile& packed) {
  z_stream& zlib = streams_->in;
  inflateReset(&zlib);
  zlib.next_in = const_cast<Bytef*>(packed.deflated.data());  // zlib does not change its input
  zlib.avail_in = static_cast<uInt>(packed.deflated.size());
  zlib.next_out = rows_.data();
  zlib.avail_out = static_cast<uInt>(rows_.size());
  return inflate(&zlib, Z_FINISH) == Z_STREAM_END && zlib.avail_out == 0 && zlib.avail_in == 0;
}

bool Packer::is_whole(const PackedTile& packed) {
  if (!read_rows(packed) || crc_of(packed.deflated) != packed.crc) return false;
  for (std::size_t row = 0; row < kSide; ++row) {
    if (rows_[row * kRow] != 0) return false;  // a filter
  }
  return true;
}

Tile Packer::pack(const Pixels& pixels) {
  for (std::size_t row = 0; row < kSide; ++row) {
    rows_[row * kRow] = 0;
    std::copy_n(pixels.data() + row * kSide, kSide, rows_.data() + row * kRow + 1);
  }
  z_stream& zlib = streams_->out;
  deflateReset(&zlib);
  zlib.next_in = rows_.data();
  zlib.avail_in = static_cast<uInt>(rows_.size());
  zlib.next_out = made_.data();
  zlib.avail_out = static_cast<uInt>(made_.size());
  deflate(&zlib, Z_FINISH);  // cannot fail: the buffer holds the largest output
  auto packed = std::make_shared<PackedTile>();
  packed->deflated.assign(made_.data(), zlib.next_out);
  packed->crc = crc_of(packed->deflated);
  return packed;
}

void Packer::unpack(const PackedTile& packed, Pixels& pixels) {
  read_rows(packed);  // cannot fail: pack() made it
  for (std::size_t row = 0; row < kSide; ++row) {
    std::copy_n(rows_.data() + row * kRow + 1, kSide, pixels.data() + row * kSide);
  }
}

}  // namespace adit::picture
