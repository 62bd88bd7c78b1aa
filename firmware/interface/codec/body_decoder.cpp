#include "codec/body_decoder.hpp"

#include <limits>
#include <string>

#include "codec/bulk_data.hpp"
#include "codec/cbor_splitter.hpp"
#include "codec/content_decoder.hpp"
#include "codec/json_splitter.hpp"
#include "icd/text.hpp"
#include "icd/try.hpp"

namespace adit::codec {
namespace {

constexpr std::string_view kBlanks = " \t";  // RFC 9110 5.6.3

}  // namespace

std::optional<Format> format_of(std::string_view content_type) {
  const std::string_view type = icd::trimmed(content_type.substr(0, content_type.find(';')), kBlanks);
  if (icd::same_but_for_case(type, "application/json")) return Format::Json;
  if (icd::same_but_for_case(type, "application/cbor")) return Format::Cbor;
  return std::nullopt;
}

std::optional<ContentCoding> coding_of(std::string_view content_encoding) {
  const std::string_view coding = icd::trimmed(content_encoding, kBlanks);
  if (coding.empty() || icd::same_but_for_case(coding, "identity")) return ContentCoding::Identity;
  if (icd::same_but_for_case(coding, "gzip") || icd::same_but_for_case(coding, "x-gzip"))
    return ContentCoding::Gzip;
  if (icd::same_but_for_case(coding, "deflate")) return ContentCoding::Deflate;
  return std::nullopt;
}

namespace {

std::unique_ptr<Splitter> splitter_for(Format format, Split split, const Limits& limits, BulkData& data) {
  const Most most{.text = limits.text_bytes, .values = limits.values};
  if (format == Format::Cbor) return std::make_unique<CborSplitter>(split, most, data);
  return std::make_unique<JsonSplitter>(split, most, data);
}

/// Limit for an inflated body. Data takes at most four characters for a byte, as integers of an array. Only
/// here, white space counts too.
std::size_t most_inflated(Split split, const Limits& limits) {
  if (split != Split::MapData) return limits.text_bytes;
  constexpr std::size_t kMost = std::numeric_limits<std::size_t>::max();
  if (limits.data_bytes > (kMost - limits.text_bytes) / 4) return kMost;
  return limits.text_bytes + 4 * limits.data_bytes;
}

constexpr std::size_t kTelling = 2;  // bytes

/// A hint for a refusal if the document looks like another format than its headers say. Uses no more bytes
/// than a splitter has read when it refuses.
std::string_view other_format(Format said, std::string_view begin) {
  if (begin.empty()) return "";
  const auto first = static_cast<std::uint8_t>(begin.front()),
             second = static_cast<std::uint8_t>(begin.back());
  if (said == Format::Cbor) {
    const bool is_object = first == '{' && std::string_view("\"} \t\r\n").contains(static_cast<char>(second));
    return is_object || begin == "\xEF\xBB" ? " (this looks like JSON; Content-Type says CBOR)" : "";
  }
  const bool is_utf_16 = first == 0 || first >= 0xFE || (first == '{' && second == 0);
  if (is_utf_16) return " (this looks like UTF-16; expected UTF-8)";
  const bool is_cbor = first >= 0x80 && first < 0xE0;  // RFC 8949 3.1: an array, a map or a tag
  return is_cbor ? " (this looks like CBOR; Content-Type says JSON)" : "";
}

}  // namespace

class BodyDecoder::Impl {
 public:
  Impl(BodyKind kind, Split split, const Limits& limits)
      : format_(kind.format),
        data_(limits.data_bytes),
        splitter_(splitter_for(kind.format, split, limits, data_)),
        content_(kind.coding, most_inflated(split, limits), [this](std::string_view bytes) {
          begin_ += bytes.substr(0, kTelling - begin_.size());
          return named(splitter_->feed(bytes));
        }) {}

  icd::Checked<void> feed(std::string_view chunk) {
    if (!spent_) return spent_;
    spent_ = content_.feed(chunk);
    return spent_;
  }

  BulkData& data() { return data_; }
  std::size_t size() const { return content_.given(); }

  icd::Checked<Document> finish() {
    if (!spent_) return std::unexpected(spent_.error());
    ADIT_TRY(content_.finish());
    auto root = ADIT_TRY(named(splitter_->finish()));
    auto data = ADIT_TRY(data_.take());
    return Document{std::move(root), std::move(data), data_.form(), data_.pressed()};
  }

 private:
  template <class T>
  icd::Checked<T> named(icd::Checked<T> checked) const {
    if (!checked) checked.error().sentence += other_format(format_, begin_);
    return checked;
  }

  Format format_;
  std::string begin_;  // beginning of the document
  BulkData data_;
  std::unique_ptr<Splitter> splitter_;
  ContentDecoder content_;
  icd::Checked<void> spent_;  // the first refusal
};

BodyDecoder::BodyDecoder(BodyKind kind, Split split, const Limits& limits)
    : impl_(std::make_unique<Impl>(kind, split, limits)) {}
BodyDecoder::~BodyDecoder() = default;
BodyDecoder::BodyDecoder(BodyDecoder&&) noexcept = default;
BodyDecoder& BodyDecoder::operator=(BodyDecoder&&) noexcept = default;

icd::Checked<void> BodyDecoder::feed(std::span<const std::uint8_t> chunk) {
  return impl_->feed({reinterpret_cast<const char*>(chunk.data()), chunk.size()});
}

std::size_t BodyDecoder::size() const {
  return impl_->size();
}

std::size_t BodyDecoder::data_held() const {
  return impl_->data().held();
}

icd::ChunkedBytes BodyDecoder::take_data() {
  return impl_->data().take_some();
}

icd::Checked<Document> BodyDecoder::finish() {
  return impl_->finish();
}

icd::Checked<Document> decode(BodyKind kind, Split split, std::string_view body, const Limits& limits) {
  BodyDecoder decoder(kind, split, limits);
  const auto* const bytes = reinterpret_cast<const std::uint8_t*>(body.data());
  ADIT_TRY(decoder.feed({bytes, body.size()}));
  return decoder.finish();
}

}  // namespace adit::codec
