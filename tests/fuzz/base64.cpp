#include "codec/base64.hpp"

#include <array>
#include <vector>

#include "target.hpp"

namespace adit::fuzz {
namespace {

/// Its bytes, or what is wrong, told with the character's place.
std::expected<std::vector<std::uint8_t>, std::string> base64_in_pieces(Input text, std::size_t piece,
                                                                       std::size_t room) {
  codec::Base64Decoder decoder;
  std::vector<std::uint8_t> all, some(room);
  std::string fault;
  in_pieces(text, piece, [&](Input run) {
    while (!run.empty()) {
      const std::size_t before = run.size();
      const auto size = decoder.decode(run, some);
      if (!size) fault = size.error();
      if (!size) return false;
      require(*size <= room && (run.size() < before || *size > 0));
      all.insert(all.end(), some.begin(), some.begin() + static_cast<std::ptrdiff_t>(*size));
    }
    return true;
  });
  if (!fault.empty()) return std::unexpected(fault);
  std::array<std::uint8_t, 2> last{};
  const auto size = decoder.finish(last);
  if (!size) return std::unexpected(size.error());
  all.insert(all.end(), last.begin(), last.begin() + static_cast<std::ptrdiff_t>(*size));
  return all;
}

}  // namespace

void try_base64(Input text) {
  const std::size_t piece = take_piece(text);
  const auto at_once = base64_in_pieces(text, text.size() + 1, text.size() + 4);
  require(at_once == base64_in_pieces(text, piece, 3 + piece));
  require(at_once == base64_in_pieces(text, 1, 3));  // by the slow way alone
  require(at_once ? at_once->size() <= (text.size() + 3) / 4 * 3 : !at_once.error().empty());
}

}  // namespace adit::fuzz
