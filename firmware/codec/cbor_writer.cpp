#include "codec/cbor_writer.hpp"

#include <cbor/encoding.h>

#include <array>
#include <span>

namespace adit::codec {

template <auto kEncode, class... Arguments>
void CborWriter::head(Arguments... arguments) {
  std::array<std::uint8_t, 9> bytes{};  // the longest head there is
  const std::size_t size = kEncode(arguments..., bytes.data(), bytes.size());
  out_.append(std::span(bytes).first(size));
}

void CborWriter::map(std::size_t members) {
  head<cbor_encode_map_start>(members);
}

void CborWriter::array(std::size_t elements) {
  head<cbor_encode_array_start>(elements);
}

void CborWriter::text(std::string_view utf8) {
  head<cbor_encode_string_start>(utf8.size());
  out_.append({reinterpret_cast<const std::uint8_t*>(utf8.data()), utf8.size()});
}

void CborWriter::whole(std::int64_t number) {
  if (number >= 0) {
    head<cbor_encode_uint>(static_cast<std::uint64_t>(number));
  } else {
    head<cbor_encode_negint>(static_cast<std::uint64_t>(-(number + 1)));
  }
}

void CborWriter::real(double number) {
  head<cbor_encode_double>(number);
}

void CborWriter::truth(bool yes) {
  head<cbor_encode_bool>(yes);
}

void CborWriter::byte_string(const icd::ChunkedBytes& bytes) {
  head<cbor_encode_bytestring_start>(bytes.size());
  out_.append(bytes);
}

}  // namespace adit::codec
