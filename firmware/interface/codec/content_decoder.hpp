#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "codec/body_decoder.hpp"
#include "icd/status.hpp"

struct z_stream_s;

namespace adit::codec {

/// Decodes a Content-Encoding (RFC 9110 8.4.1) on arrival: gzip with one or more members (RFC 1952 2.2), or
/// exactly one deflate stream, raw or in zlib's wrapping. Errors: 400, 413 over the limit of all members.
class ContentDecoder {
 public:
  using Sink = std::function<icd::Checked<void>(std::string_view)>;

  /// `sink` gets at most `most` bytes in total.
  ContentDecoder(ContentCoding coding, std::size_t most, Sink sink);

  icd::Checked<void> feed(std::string_view bytes);
  icd::Checked<void> finish();
  std::size_t decoded_bytes() const { return given_; }

 private:
  struct End {
    void operator()(z_stream_s* stream) const;
  };
  icd::Checked<void> begin(int window_bits);
  icd::Checked<void> inflate(std::string_view bytes);
  icd::Checked<void> give(std::string_view bytes);
  icd::Refusal bad(std::string_view why) const;

  ContentCoding coding_;
  std::size_t most_, given_ = 0;
  Sink sink_;
  std::string head_;  // of a deflate body, until its kind is known
  std::unique_ptr<z_stream_s, End> stream_;
  bool ended_ = false;     // at the end of a member or stream
  bool is_later_ = false;  // not the first member
};

}  // namespace adit::codec
