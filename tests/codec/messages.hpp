#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <ostream>
#include <random>
#include <string>
#include <vector>

#include "codec/body_decoder.hpp"
#include "icd/mapping.hpp"
#include "icd/status.hpp"

/// Request bodies and messages for tests of the message level. They are made only with nlohmann-json and
/// zlib, so they are independent of the code under test.
namespace adit::codec::test {

using nlohmann::json;
using Bytes = std::vector<std::uint8_t>;

/// In chunks, as from a network.
inline icd::ChunkedBytes in_pieces(const Bytes& bytes, std::size_t piece) {
  icd::ChunkedBytes chunked;
  for (std::size_t i = 0; i < bytes.size(); i += piece) {
    chunked.append(Bytes(bytes.begin() + i, bytes.begin() + std::min(i + piece, bytes.size())));
  }
  return chunked;
}
using Random = std::mt19937_64;

/// Valid messages with every member that the ICD lists. A map's data is binary.
json good_grid();   // 4 x 3 cells
json good_cloud();  // 2 points of x, y, z, rgba
json good_state();
json good_markers();
json good_report();
json quaternion(double x, double y, double z, double w);

std::string base64(const Bytes& bytes);
/// With each binary as a base64 string.
std::string as_json(const json& message);
std::string as_cbor(const json& message);

/// By zlib. `window` is deflateInit2's: 31 gzip, 15 zlib, -15 raw deflate.
Bytes compressed(const Bytes& bytes, int window = 31);
/// Decompresses `bytes`, which must be exactly one gzip member.
Bytes only_member(const Bytes& bytes);

/// The sentence of an error, after its status if that is not 422; "accepted" if there is no error.
template <class T>
std::string sentence_of(const icd::Checked<T>& checked) {
  if (checked) return "accepted";
  if (checked.error().status != icd::Status::UnprocessableEntity)
    return std::to_string(static_cast<int>(checked.error().status)) + ": " + checked.error().sentence;
  return checked.error().sentence;
}

/// Compares all members, and the data before compression.
void expect_same(const icd::MapUpdate& map, const icd::MapUpdate& expected);
/// The map with the values of a big-endian cloud converted, as the codec reads it.
icd::MapUpdate little_endian(icd::MapUpdate map);
Bytes raw_data(const icd::MapData& data);

icd::MapUpdate random_grid(Random& random);
icd::MapUpdate random_cloud(Random& random);
icd::StateUpdate random_state(Random& random);
icd::MarkersUpdate random_markers(Random& random);

}  // namespace adit::codec::test
