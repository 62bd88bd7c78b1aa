#pragma once

#include <algorithm>
#include <string>
#include <string_view>

#include "intake/request.hpp"

namespace adit::intake {

struct ReadChunks {
  ChunkReader::State state;
  std::string data;
  friend bool operator==(const ReadChunks&, const ReadChunks&) = default;
};

/// Reads a chunked body in pieces of this size.
inline ReadChunks read_chunks(std::string_view body, std::size_t piece) {
  ChunkReader reader;
  std::string data;
  for (; !body.empty(); body.remove_prefix(std::min(piece, body.size()))) {
    reader.feed(body.substr(0, piece), data);
  }
  return {reader.state(), data};
}

}  // namespace adit::intake
