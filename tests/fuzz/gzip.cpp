// A map's data under gzip.
#include "codec/gzip.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "target.hpp"

namespace adit::fuzz {
namespace {

constexpr std::size_t kMostInflated = 1 << 18;

icd::Checked<std::string> inflated(icd::ChunkedBytes bytes) {
  std::string all;
  const auto size = codec::gunzip(std::move(bytes), kMostInflated, "msg.data", [&](auto piece) {
    all.append(reinterpret_cast<const char*>(piece.data()), piece.size());
    return icd::Checked<void>{};
  });
  if (!size) return std::unexpected(size.error());
  require(size->size == all.size() && size->members > 0 && all.size() <= kMostInflated);
  return all;
}

}  // namespace

void try_gzip(Input text) {
  const std::size_t piece = take_piece(text);
  icd::ChunkedBytes cut;
  in_pieces(text, piece, [&cut](Input each) {
    cut.append(std::vector<std::uint8_t>(each.begin(), each.end()));
    return true;
  });
  const auto said = inflated(icd::ChunkedBytes(bytes_of(text)));
  const auto said_of_pieces = inflated(cut);
  require(said.has_value() == said_of_pieces.has_value());
  if (said) require(*said == *said_of_pieces);
  if (!said) require(said.error().sentence.starts_with("msg.data"));
  const auto at_once =
      codec::gunzip(cut, said ? said->size() : std::min(codec::claimed_size(cut), kMostInflated));
  if (said && at_once) require(std::ranges::equal(*at_once, bytes_of(*said)));
  // Nothing may follow a member but others.
  if (said) require(!inflated(icd::ChunkedBytes(bytes_of(std::string(text) + "x"))));
  if (said && said->size() <= kMostInflated / 2)
    require(inflated(icd::ChunkedBytes(bytes_of(std::string(text) + std::string(text)))) == *said + *said);

  for (const auto strategy : {codec::GzipStrategy::Default, codec::GzipStrategy::Runs}) {
    const auto member = codec::gzip(icd::ChunkedBytes(bytes_of(text)), strategy);
    require(inflated(member) == std::string(text));
  }
  const auto whole = bytes_of(text);
  for (const int level : {codec::kFastestLevel, 6, codec::kSmallestLevel}) {
    const auto member = codec::gzip(whole, level, whole.size());
    if (member) require(member->size() <= whole.size() && inflated(*member) == std::string(text));
  }
}

}  // namespace adit::fuzz
