#pragma once

#include <gtest/gtest.h>
#include <zlib.h>

#include <cstdint>
#include <vector>

#include "icd/chunked_bytes.hpp"

namespace adit::pack {

/// What zlib itself inflates of the one gzip member that `bytes` are; fails the test where they are none, or
/// where anything follows it. `most`: more than is expected.
inline std::vector<std::uint8_t> only_member(const icd::ChunkedBytes& bytes, std::size_t most) {
  std::vector<std::uint8_t> member = bytes.to_vector(), out(most + 1);
  z_stream stream{};
  inflateInit2(&stream, MAX_WBITS + 16);
  stream.next_in = member.data();
  stream.avail_in = static_cast<uInt>(member.size());
  stream.next_out = out.data();
  stream.avail_out = static_cast<uInt>(out.size());
  EXPECT_EQ(inflate(&stream, Z_FINISH), Z_STREAM_END) << (stream.msg == nullptr ? "cut short" : stream.msg);
  EXPECT_EQ(stream.avail_in, 0U) << "bytes after the member";
  out.resize(stream.total_out);
  inflateEnd(&stream);
  return out;
}

}  // namespace adit::pack
