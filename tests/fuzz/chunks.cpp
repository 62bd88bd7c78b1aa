// A chunked body, in pieces: the input's last byte says how large they are.
#include <algorithm>
#include <cstdlib>
#include <string>

#include "intake/chunk_reader.hpp"

namespace {

using adit::intake::ChunkReader;

struct Outcome {
  ChunkReader::State state;
  std::string data;
  bool operator==(const Outcome&) const = default;
};

Outcome read(std::string_view body, std::size_t piece) {
  ChunkReader reader;
  std::string data;
  for (; !body.empty(); body.remove_prefix(std::min(piece, body.size()))) {
    reader.feed(body.substr(0, piece), data);
  }
  return {reader.state(), data};
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view body(reinterpret_cast<const char*>(bytes), size - 1);
  const Outcome at_once = read(body, body.size() + 1), in_pieces = read(body, 1U + bytes[size - 1] % 64U);
  if (at_once != in_pieces || at_once.data.size() > body.size()) std::abort();
  return 0;
}
