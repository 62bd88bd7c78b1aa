#include "store/frame.hpp"

#include <libdeflate.h>

#include <bit>

namespace adit::store {

void Writer::operator()(std::uint64_t number) {
  put_number(bytes_, number, 8);
}

void Writer::operator()(double real) {
  (*this)(std::bit_cast<std::uint64_t>(real));
}

void Writer::operator()(std::string_view text) {
  (*this)(text.size());
  bytes_ += text;
}

std::string_view Reader::consume(std::size_t size) {
  check(size <= left_.size());
  if (!ok_) return {};
  const std::string_view taken = left_.substr(0, size);
  left_.remove_prefix(size);
  return taken;
}

std::uint64_t Reader::number() {
  const std::string_view bytes = consume(8);
  return bytes.empty() ? 0 : number_at(bytes, 0, 8);
}

void Reader::operator()(double& real) {
  real = std::bit_cast<double>(number());
}

namespace {

constexpr std::uint64_t kMagic = 0x4C544441;  // "ADTL"
constexpr std::size_t kChecked = 8;           // offset of the checksummed part
constexpr std::size_t kHeader = 40;

/// CRC-32 (RFC 1952) of the salt, the offset and the frame, so that a frame is valid only in its place.
std::uint32_t checksum(std::string_view checked, std::uint64_t salt, std::size_t offset) {
  std::string place;
  put_number(place, salt, 8);
  put_number(place, offset, 8);
  const std::uint32_t sum = libdeflate_crc32(0, place.data(), place.size());
  return libdeflate_crc32(sum, checked.data(), checked.size());
}

std::size_t align_up(std::size_t offset, const Layout& layout) {
  return (offset + layout.align - 1) / layout.align * layout.align;
}

}  // namespace

void put_number(std::string& out, std::uint64_t number, std::size_t bytes) {
  if constexpr (std::endian::native == std::endian::big) number = std::byteswap(number);
  out.append(reinterpret_cast<const char*>(&number), bytes);
}

std::uint64_t number_at(std::string_view bytes, std::size_t at, std::size_t size) {
  std::uint64_t number = 0;
  for (std::size_t i = size; i > 0; --i) number = number << 8 | static_cast<std::uint8_t>(bytes[at + i - 1]);
  return number;
}

std::size_t room_of(std::size_t body, const Layout& layout) {
  return align_up(kHeader + body, layout);
}

std::string to_bytes(const Frame& frame, const Layout& layout, std::uint64_t salt, std::size_t offset) {
  std::string all;
  all.reserve(layout.copies * room_of(frame.body.size(), layout));
  for (std::size_t copy = 0; copy < layout.copies; ++copy) {
    all.resize(copy * room_of(frame.body.size(), layout));
    std::string checked;
    checked.reserve(kHeader - kChecked + frame.body.size());
    put_number(checked, frame.body.size(), 4);
    put_number(checked, frame.kind, 1);
    put_number(checked, copy, 1);
    put_number(checked, 0, 2);
    put_number(checked, frame.sequence, 8);
    put_number(checked, frame.process, 8);
    put_number(checked, frame.durable, 8);
    checked += frame.body;
    put_number(all, kMagic, 4);
    put_number(all, checksum(checked, salt, offset + all.size() - 4), 4);
    all += checked;
  }
  return all;
}

std::optional<ParsedFrame> parse(std::string_view file, std::size_t offset, std::uint64_t salt) {
  if (offset > file.size() || file.size() - offset < kHeader) return std::nullopt;
  const std::string_view here = file.substr(offset);
  const std::uint64_t length = number_at(here, 8, 4);
  if (number_at(here, 0, 4) != kMagic || length > kMostBody || length > here.size() - kHeader || here[13] > 1)
    return std::nullopt;
  if (number_at(here, 4, 4) != checksum(here.substr(kChecked, kHeader - kChecked + length), salt, offset))
    return std::nullopt;
  return ParsedFrame{{.kind = static_cast<std::uint8_t>(here[12]),
                      .sequence = number_at(here, 16, 8),
                      .process = number_at(here, 24, 8),
                      .durable = number_at(here, 32, 8),
                      .body = here.substr(kHeader, length)},
                     static_cast<std::uint8_t>(here[13])};
}

std::size_t next_candidate(std::string_view file, std::size_t offset, const Layout& layout) {
  for (offset = align_up(offset, layout); offset + kHeader <= file.size(); offset += layout.align) {
    if (number_at(file, offset, 4) == kMagic) return offset;
  }
  return file.size();
}

}  // namespace adit::store
