#pragma once

#include <zlib.h>

#include <cstdint>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace adit::picture {

/// What a viewer makes of an indexed PNG; written from ISO/IEC 15948 for the tests alone. Throws where the
/// standard is not kept.
struct DecodedPng {
  std::uint32_t width = 0, height = 0;
  std::string palette, alpha;         // PLTE and tRNS
  std::vector<std::uint8_t> indices;  // row by row from the top
  std::vector<std::string> chunks;    // their names, in order
};

inline std::uint32_t number_at(const std::string& bytes, std::size_t at) {
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < 4; ++i) number = number << 8 | static_cast<std::uint8_t>(bytes.at(at + i));
  return number;
}

inline std::uint32_t crc_of(const std::string& bytes) {  // Annex D, bit by bit
  std::uint32_t crc = 0xffffffff;
  for (const char byte : bytes) {
    crc ^= static_cast<std::uint8_t>(byte);
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 1) != 0 ? 0xedb88320 ^ crc >> 1 : crc >> 1;
  }
  return ~crc;
}

inline void require(bool kept, const char* what) {
  if (!kept) throw std::runtime_error(what);
}

inline DecodedPng decode_png(const std::string& png) {
  require(png.starts_with(std::string("\x89PNG\r\n\x1a\n", 8)), "signature");
  DecodedPng decoded;
  std::string deflated;
  for (std::size_t at = 8; at < png.size();) {
    const std::size_t size = number_at(png, at);
    const std::string name = png.substr(at + 4, 4), content = png.substr(at + 8, size);
    require(content.size() == size, "a chunk is cut short");
    require(number_at(png, at + 8 + size) == crc_of(name + content), "a chunk's checksum");
    decoded.chunks.push_back(name);
    if (name == "IHDR") {
      decoded.width = number_at(content, 0), decoded.height = number_at(content, 4);
      require(content.substr(8) == std::string("\x08\x03\x00\x00\x00", 5), "8 bits, indexed, not interlaced");
    } else if (name == "PLTE") {
      decoded.palette = content;
    } else if (name == "tRNS") {
      decoded.alpha = content;
    } else if (name == "IDAT") {
      deflated += content;
    }
    at += size + 12;
  }
  uLongf size = (decoded.width + 1) * decoded.height;
  std::vector<std::uint8_t> rows(size + 1);
  uLongf made = rows.size();
  require(uncompress(rows.data(), &made, reinterpret_cast<const Bytef*>(deflated.data()), deflated.size()) ==
              Z_OK,
          "the zlib stream");
  require(made == size, "as many bytes as pixels and filters");
  for (std::uint32_t row = 0; row < decoded.height; ++row) {
    const auto begin = rows.begin() + static_cast<std::ptrdiff_t>(row) * (decoded.width + 1);
    require(*begin == 0, "no filter");
    decoded.indices.insert(decoded.indices.end(), begin + 1, begin + 1 + decoded.width);
  }
  return decoded;
}

}  // namespace adit::picture
