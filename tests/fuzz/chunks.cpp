// A chunked body.
#include "intake/read_chunks.hpp"
#include "target.hpp"

namespace adit::fuzz {

void try_chunks(Input body) {
  const std::size_t piece = take_piece(body);
  const auto at_once = intake::read_chunks(body, body.size() + 1);
  require(at_once == intake::read_chunks(body, piece) && at_once.data.size() <= body.size());
}

}  // namespace adit::fuzz
