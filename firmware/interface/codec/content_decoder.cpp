#include "codec/content_decoder.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "icd/sentence.hpp"

namespace adit::codec {
namespace {

constexpr std::size_t kInflatedPiece = 32UL * 1024;

/// RFC 1950 2.2: deflate, window of at most 32 KiB, check value. Raw deflate of compressors never begins so.
bool has_zlib_header(std::string_view head) {
  const auto cmf = static_cast<unsigned char>(head[0]);
  const auto flags = static_cast<unsigned char>(head[1]);
  return (cmf & 0x0F) == Z_DEFLATED && (cmf >> 4) <= 7 && (cmf * 256 + flags) % 31 == 0;
}

}  // namespace

void ContentDecoder::End::operator()(z_stream_s* stream) const {
  inflateEnd(stream);
  delete stream;
}

ContentDecoder::ContentDecoder(ContentCoding coding, std::size_t most, Sink sink)
    : coding_(coding), most_(most), sink_(std::move(sink)) {}

icd::Checked<void> ContentDecoder::feed(std::string_view bytes) {
  if (coding_ == ContentCoding::Identity) return give(bytes);
  if (bytes.empty()) return {};
  if (stream_ != nullptr) return inflate(bytes);
  if (coding_ == ContentCoding::Gzip) {
    if (auto begun = begin(15 + 16); !begun) return begun;
    return inflate(bytes);
  }
  const std::size_t wanted = std::min(2 - head_.size(), bytes.size());
  head_ += bytes.substr(0, wanted);
  bytes.remove_prefix(wanted);
  if (head_.size() < 2) return {};
  if (auto begun = begin(has_zlib_header(head_) ? 15 : -15); !begun) return begun;
  if (auto taken = inflate(head_); !taken || bytes.empty()) return taken;
  return inflate(bytes);
}

icd::Checked<void> ContentDecoder::finish() {
  if (coding_ == ContentCoding::Identity || ended_) return {};
  return std::unexpected(bad("the body is cut short"));
}

icd::Checked<void> ContentDecoder::begin(int window_bits) {
  auto stream = std::make_unique<z_stream>();
  if (inflateInit2(stream.get(), window_bits) != Z_OK) {
    return icd::refuse(icd::Status::InternalServerError, "no memory to inflate the body");
  }
  stream_.reset(stream.release());
  return {};
}

icd::Checked<void> ContentDecoder::inflate(std::string_view bytes) {
  std::array<char, kInflatedPiece> piece;  // not cleared, for speed
  while (true) {
    if (std::exchange(ended_, false)) {
      if (coding_ != ContentCoding::Gzip) return std::unexpected(bad("bytes after its end"));
      inflateReset(stream_.get());
      is_later_ = true;
    }
    const std::size_t some = std::min<std::size_t>(bytes.size(), std::numeric_limits<uInt>::max());
    stream_->next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));  // zlib only reads it
    stream_->avail_in = static_cast<uInt>(some);
    stream_->next_out = reinterpret_cast<Bytef*>(piece.data());
    stream_->avail_out = kInflatedPiece;
    const int result = ::inflate(stream_.get(), Z_NO_FLUSH);
    bytes.remove_prefix(some - stream_->avail_in);
    const std::size_t size = kInflatedPiece - stream_->avail_out;
    if (auto given = give({piece.data(), size}); !given) return given;
    ended_ = result == Z_STREAM_END;
    if (ended_ && bytes.empty()) return {};
    if (ended_) continue;
    if (result == Z_NEED_DICT) return std::unexpected(bad("it needs a dictionary"));
    if (result == Z_MEM_ERROR) {
      return icd::refuse(icd::Status::InternalServerError, "no memory to inflate the body");
    }
    if (result != Z_OK && result != Z_BUF_ERROR) {
      return std::unexpected(bad(stream_->msg != nullptr ? stream_->msg : "damaged data"));
    }
    if (bytes.empty() && stream_->avail_out > 0) return {};  // all input is used
  }
}

icd::Checked<void> ContentDecoder::give(std::string_view bytes) {
  if (bytes.empty()) return {};
  if (bytes.size() > most_ - given_) {
    return icd::refuse(icd::Status::ContentTooLarge, coding_ == ContentCoding::Identity
                                                         ? "the body is too large"
                                                         : "the inflated body is too large");
  }
  given_ += bytes.size();
  return sink_(bytes);
}

icd::Refusal ContentDecoder::bad(std::string_view why) const {
  const std::string_view name = coding_ == ContentCoding::Gzip ? "gzip" : "deflate";
  return {icd::Status::BadRequest,
          icd::sentence("Content-Encoding ", name, is_later_ ? ", after a whole member: " : ": ", why)};
}

}  // namespace adit::codec
