#include "picture/png.hpp"

#include <zlib.h>

#include <string_view>

namespace adit::picture {
namespace {

constexpr std::string_view kSignature{"\x89PNG\r\n\x1a\n", 8};
constexpr char kBitDepth = 8, kIndexed = 3;

void append_number(std::string& png, std::uint32_t number) {  // PNG 7.1: most significant byte first
  for (const int shift : {24, 16, 8, 0}) png.push_back(static_cast<char>(number >> shift & 0xff));
}

void append_chunk(std::string& png, std::string_view type, std::string_view content) {
  append_number(png, static_cast<std::uint32_t>(content.size()));
  const std::size_t begin = png.size();
  png.append(type).append(content);
  const auto* summed = reinterpret_cast<const Bytef*>(png.data() + begin);
  append_number(png, static_cast<std::uint32_t>(crc32(0, summed, static_cast<uInt>(png.size() - begin))));
}

std::string head() {
  std::string content;
  append_number(content, kSide);
  append_number(content, kSide);
  return content + kBitDepth + kIndexed + std::string(3, '\0');  // deflate, usual filters, no interlace
}

std::string bytes_of(std::span<const Colour> palette) {
  std::string bytes;
  for (const Colour& colour : palette) {
    for (const std::uint8_t part : {colour.red, colour.green, colour.blue}) {
      bytes.push_back(static_cast<char>(part));
    }
  }
  return bytes;
}

}  // namespace

std::string write_png(const Packed& tile, std::span<const Colour> palette) {
  constexpr std::size_t kFraming = 128;
  std::string png;
  png.reserve(tile.deflated.size() + palette.size() * 3 + kFraming);
  png += kSignature;
  append_chunk(png, "IHDR", head());
  append_chunk(png, "PLTE", bytes_of(palette));
  append_chunk(png, "tRNS", std::string_view("\0", 1));  // of index 0; the others are opaque
  append_number(png, static_cast<std::uint32_t>(tile.deflated.size()));
  png.append("IDAT").append(reinterpret_cast<const char*>(tile.deflated.data()), tile.deflated.size());
  append_number(png, tile.crc);
  append_chunk(png, "IEND", {});
  return png;
}

}  // namespace adit::picture
