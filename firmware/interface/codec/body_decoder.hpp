#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string_view>

#include "codec/value.hpp"
#include "icd/chunked_bytes.hpp"
#include "icd/status.hpp"

namespace adit::codec {

enum class Format : std::uint8_t { Json, Cbor };
enum class ContentCoding : std::uint8_t { Identity, Gzip, Deflate };  // RFC 9110 8.4.1; deflate: zlib or raw

/// A body's form according to its headers.
struct BodyKind {
  Format format = Format::Json;
  ContentCoding coding = ContentCoding::Identity;
};

/// Reads Content-Type, ignoring parameters and case. std::nullopt: neither JSON nor CBOR.
std::optional<Format> format_of(std::string_view content_type);
/// Reads Content-Encoding: "" (absent), identity, gzip, x-gzip or deflate. std::nullopt: another.
std::optional<ContentCoding> coding_of(std::string_view content_encoding);

struct Limits {
  std::size_t text_bytes = 1u << 20;  // the inflated document without its bulk data
  /// Values in the document, because each takes up to 250 bytes to parse, however short it is.
  std::size_t values = std::numeric_limits<std::size_t>::max();
  std::size_t data_bytes = 256u << 20;  // bulk data after inflating the body, before inflating the data
};

/// The part that is not parsed with the rest.
enum class Split : std::uint8_t {
  Nothing,
  MapData,  // the value at "msg.data", split off as it arrives
  Lists,    // array elements, each parsed on demand (List)
};

enum class DataForm : std::uint8_t {
  Absent,
  Base64,      // decoded JSON string
  ByteString,  // CBOR byte string, definite or in chunks
  Integers,    // array of integers from -1 to 255, one byte each; -1 becomes 255
};

/// A grid's cells, compressed on arrival because the body had declared a grid before.
struct PressedCells {
  std::size_t count = 0;
  icd::Checked<void> checked;  // 422 about the first invalid cell; only cells before it are stored
};

struct Document {
  Value root;
  icd::ChunkedBytes data;
  DataForm data_form = DataForm::Absent;
  std::optional<PressedCells> pressed;  // state of compressed `data`; nullopt: `data` is as received
};

/// Parses a request body in chunks of any size.
///
/// Checks well-formedness on arrival (RFC 8259 strictly, RFC 8949 5.3.1) and limits nesting to 64, without
/// holding the whole body at any step. A map's data goes to Document::data in chunks; the rest, within
/// text_bytes and values, is parsed at the end. Errors: 400 not well-formed, 413 over a limit, 422 bulk data
/// of an invalid kind. After an error the decoder cannot be used.
class BodyDecoder {
 public:
  static constexpr int kDeepest = 64;

  BodyDecoder(BodyKind kind, Split split, const Limits& limits);
  ~BodyDecoder();
  BodyDecoder(BodyDecoder&&) noexcept;
  BodyDecoder& operator=(BodyDecoder&&) noexcept;

  icd::Checked<void> feed(std::span<const std::uint8_t> chunk);
  /// Inflated bytes of the document so far, with bulk data.
  std::size_t size() const;
  /// held_bytes(): bytes of bulk data in the decoder. take_data() removes and returns them, for callers that
  /// store data on arrival; finish() then returns the rest.
  std::size_t held_bytes() const;
  icd::ChunkedBytes take_data();
  /// Call once, after the last feed().
  icd::Checked<Document> finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Parses a small, complete body.
icd::Checked<Document> decode(BodyKind kind, Split split, std::string_view body, const Limits& limits = {});

}  // namespace adit::codec
