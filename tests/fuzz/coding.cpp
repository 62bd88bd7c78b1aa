// A body under Content-Encoding: gzip, or deflate with or without zlib's wrapping.
#include "codec/content_decoder.hpp"
#include "target.hpp"

namespace adit::fuzz {
namespace {

constexpr std::size_t kMostDecoded = 1 << 18;

icd::Checked<std::string> decoded(codec::ContentCoding coding, Input text, std::size_t piece) {
  std::string all;
  codec::ContentDecoder decoder(coding, kMostDecoded, [&all](std::string_view bytes) {
    all += bytes;
    return icd::Checked<void>{};
  });
  icd::Checked<void> fed;
  in_pieces(text, piece, [&](Input each) { return (fed = decoder.feed(each)).has_value(); });
  if (fed) fed = decoder.finish();
  require(all.size() <= kMostDecoded);
  if (!fed) return std::unexpected(fed.error());
  return all;
}

}  // namespace

void try_coding(Input text) {
  const std::size_t piece = take_piece(text);
  using enum codec::ContentCoding;
  for (const auto coding : {Identity, Gzip, Deflate}) {
    const auto at_once = decoded(coding, text, text.size() + 1);
    const auto cut = decoded(coding, text, piece);
    require(at_once.has_value() == cut.has_value());
    if (at_once) require(*at_once == *cut);
    if (!at_once) require(!at_once.error().sentence.empty() && at_once.error().status == cut.error().status);
  }
}

}  // namespace adit::fuzz
