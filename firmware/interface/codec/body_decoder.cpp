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
  const std::string_view type = icd::trim(content_type.substr(0, content_type.find(';')), kBlanks);
  if (icd::equals_ignoring_case(type, "application/json")) return Format::Json;
  if (icd::equals_ignoring_case(type, "application/cbor")) return Format::Cbor;
  return std::nullopt;
}

std::optional<ContentCoding> coding_of(std::string_view content_encoding) {
  const std::string_view coding = icd::trim(content_encoding, kBlanks);
  if (coding.empty() || icd::equals_ignoring_case(coding, "identity")) return ContentCoding::Identity;
  if (icd::equals_ignoring_case(coding, "gzip") || icd::equals_ignoring_case(coding, "x-gzip"))
    return ContentCoding::Gzip;
  if (icd::equals_ignoring_case(coding, "deflate")) return ContentCoding::Deflate;
  return std::nullopt;
}

namespace {

std::unique_ptr<Splitter> splitter_for(Format format, Split split, const Limits& limits, BulkData& data) {
  const DocumentLimits most{.text = limits.text_bytes,
                            .values = limits.values,
                            .but = split == Split::MapData ? " without msg.data" : ""};
  if (format == Format::Cbor) return std::make_unique<CborSplitter>(split, most, data);
  return std::make_unique<JsonSplitter>(split, most, data);
}

/// Data takes at most four characters for a byte, as integers of an array. Only here, white space counts.
std::size_t most_inflated(Split split, const Limits& limits) {
  if (split != Split::MapData) return limits.text_bytes;
  constexpr std::size_t kMost = std::numeric_limits<std::size_t>::max();
  if (limits.data_bytes > (kMost - limits.text_bytes) / 4) return kMost;
  return limits.text_bytes + 4 * limits.data_bytes;
}

constexpr std::size_t kTelling = 2;  // bytes

/// A hint for a refusal if the document looks like another format than its headers say. Uses no more bytes
/// than a splitter has read when it refuses.
std::string_view detect_format(Format said, std::string_view begin) {
  if (begin.empty()) return "";
  const auto first = static_cast<std::uint8_t>(begin.front()),
             second = static_cast<std::uint8_t>(begin.back());
  constexpr std::uint8_t kGzip = 0x1f;  // no JSON and no CBOR begins so
  if (first == kGzip) return " (this looks like gzip; expected Content-Encoding: gzip)";
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

struct BodyDecoder::Impl {
  Impl(BodyKind kind, Split split, const Limits& limits)
      : format(kind.format),
        data(limits.data_bytes),
        splitter(splitter_for(kind.format, split, limits, data)),
        content(kind.coding, most_inflated(split, limits), [this](std::string_view bytes) {
          begin += bytes.substr(0, kTelling - begin.size());
          return add_format(splitter->feed(bytes));
        }) {}

  template <class T>
  icd::Checked<T> add_format(icd::Checked<T> checked) const {
    if (!checked) checked.error().sentence += detect_format(format, begin);
    return checked;
  }

  Format format;
  std::string begin;  // beginning of the document
  BulkData data;
  std::unique_ptr<Splitter> splitter;
  ContentDecoder content;
  icd::Checked<void> spent;  // the first refusal
};

BodyDecoder::BodyDecoder(BodyKind kind, Split split, const Limits& limits)
    : impl_(std::make_unique<Impl>(kind, split, limits)) {}
BodyDecoder::~BodyDecoder() = default;
BodyDecoder::BodyDecoder(BodyDecoder&&) noexcept = default;
BodyDecoder& BodyDecoder::operator=(BodyDecoder&&) noexcept = default;

icd::Checked<void> BodyDecoder::feed(std::span<const std::uint8_t> chunk) {
  if (impl_->spent)
    impl_->spent = impl_->content.feed({reinterpret_cast<const char*>(chunk.data()), chunk.size()});
  return impl_->spent;
}

std::size_t BodyDecoder::size() const {
  return impl_->content.decoded_bytes();
}

std::size_t BodyDecoder::held_bytes() const {
  return impl_->data.available();
}

icd::ChunkedBytes BodyDecoder::take_data() {
  return impl_->data.take_some();
}

icd::Checked<Document> BodyDecoder::finish() {
  if (!impl_->spent) return std::unexpected(impl_->spent.error());
  ADIT_TRY(impl_->content.finish());
  auto root = ADIT_TRY(impl_->add_format(impl_->splitter->finish()));
  auto data = ADIT_TRY(impl_->data.take_rest());
  return Document{std::move(root), std::move(data), impl_->data.form(), impl_->data.pressed_cells()};
}

icd::Checked<Document> decode(BodyKind kind, Split split, std::string_view body, const Limits& limits) {
  BodyDecoder decoder(kind, split, limits);
  const auto* const bytes = reinterpret_cast<const std::uint8_t*>(body.data());
  ADIT_TRY(decoder.feed({bytes, body.size()}));
  return decoder.finish();
}

}  // namespace adit::codec
