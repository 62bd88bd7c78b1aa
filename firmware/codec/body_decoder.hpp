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

/// What the headers say a body is.
struct BodyKind {
  Format format = Format::Json;
  ContentCoding coding = ContentCoding::Identity;
};

/// Content-Type, with any parameters, in any letter case. Nothing: neither JSON nor CBOR.
std::optional<Format> format_of(std::string_view content_type);
/// Content-Encoding: absent (""), identity, gzip, x-gzip or deflate. Nothing: another.
std::optional<ContentCoding> coding_of(std::string_view content_encoding);

struct Limits {
  std::size_t text_bytes = 1u << 20;  // the document without its bulk data, after inflating
  /// In it: to parse one takes up to 250 bytes, however short it is.
  std::size_t values = std::numeric_limits<std::size_t>::max();
  std::size_t data_bytes = 256u << 20;  // bulk data, after inflating the body, before inflating the data
};

/// What is not parsed with the rest.
enum class Split : std::uint8_t {
  Nothing,
  MapData,  // the value at "msg.data", which is split from the rest as it arrives
  Lists,    // the elements of each array: one by one, when they are asked for (List)
};

/// How the bulk data stood in the body.
enum class DataForm : std::uint8_t {
  Absent,
  Base64,      // JSON string, decoded
  ByteString,  // CBOR major type 2, definite or in chunks
  Integers,    // array of integers -1 to 255, one byte each, -1 as 255
};

/// A grid's cells that were gzipped as they arrived, because the body had said before that it is a grid.
struct PressedCells {
  std::size_t count = 0;
  icd::Checked<void> checked;  // 422 about the first that no cell may be; those before it alone are there
};

struct Document {
  Value root;
  icd::ChunkedBytes data;
  DataForm data_form = DataForm::Absent;
  std::optional<PressedCells> pressed;  // that are in `data`; nothing: it is as it came
};

/// Parses one request body given in chunks of any size.
///
/// Well-formedness is checked as the bytes arrive (RFC 8259 strictly, RFC 8949 5.3.1), nesting is at most 64,
/// and no step holds the whole body. A map's data goes to Document::data in chunks; the rest, at most
/// text_bytes and so many values, is read at the end. Refusals: 400 not well-formed, 413 over a limit, 422
/// bulk data of another kind than the format allows. After a refusal the decoder is spent.
class BodyDecoder {
 public:
  static constexpr int kDeepest = 64;

  BodyDecoder(BodyKind kind, Split split, const Limits& limits);
  ~BodyDecoder();
  BodyDecoder(BodyDecoder&&) noexcept;
  BodyDecoder& operator=(BodyDecoder&&) noexcept;

  icd::Checked<void> feed(std::span<const std::uint8_t> chunk);
  /// How much of the document has come, inflated, with its bulk data.
  std::size_t size() const;
  /// How much bulk data is held, and all of that, which the decoder is rid of then: for whoever puts it
  /// somewhere else as it comes. finish() gives the rest of it.
  std::size_t data_held() const;
  icd::ChunkedBytes take_data();
  /// Once, after the last feed.
  icd::Checked<Document> finish();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

/// The whole of a small body at once.
icd::Checked<Document> decode(BodyKind kind, Split split, std::string_view body, const Limits& limits = {});

}  // namespace adit::codec
