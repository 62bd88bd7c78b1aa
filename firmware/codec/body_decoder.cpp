#include "codec/body_decoder.hpp"

#include <limits>
#include <string>

#include "codec/bulk_data.hpp"
#include "codec/cbor_splitter.hpp"
#include "codec/content_decoder.hpp"
#include "codec/json_at_once.hpp"
#include "codec/json_splitter.hpp"

namespace adit::codec {
namespace {

std::unique_ptr<Splitter> splitter_for(Format format, Split split, const Limits& limits, BulkData& data) {
  const Most most{.text = limits.text_bytes, .values = limits.values};
  if (format == Format::Cbor) return std::make_unique<CborSplitter>(split, most, data);
  if (split == Split::Nothing) return std::make_unique<JsonAtOnce>(most);
  return std::make_unique<JsonSplitter>(split, most, data);
}

/// What a body may inflate to. Most that data takes is four characters for a byte, as the integers of an
/// array; white space counts here alone.
std::size_t most_inflated(Split split, const Limits& limits) {
  if (split != Split::MapData) return limits.text_bytes;
  constexpr std::size_t kMost = std::numeric_limits<std::size_t>::max();
  if (limits.data_bytes > (kMost - limits.text_bytes) / 4) return kMost;
  return limits.text_bytes + 4 * limits.data_bytes;
}

}  // namespace

class BodyDecoder::Impl {
 public:
  Impl(BodyKind kind, Split split, const Limits& limits)
      : data_(limits.data_bytes),
        splitter_(splitter_for(kind.format, split, limits, data_)),
        content_(kind.coding, most_inflated(split, limits),
                 [this](std::string_view bytes) { return splitter_->feed(bytes); }) {}

  icd::Checked<void> feed(std::string_view chunk) {
    if (!spent_) return spent_;
    spent_ = content_.feed(chunk);
    return spent_;
  }

  BulkData& data() { return data_; }
  std::size_t size() const { return content_.given(); }

  icd::Checked<Document> finish() {
    if (!spent_) return std::unexpected(spent_.error());
    if (auto whole = content_.finish(); !whole) return std::unexpected(whole.error());
    auto root = splitter_->finish();
    if (!root) return std::unexpected(root.error());
    auto data = data_.take();
    if (!data) return std::unexpected(data.error());
    return Document{std::move(*root), std::move(*data), data_.form(), data_.pressed()};
  }

 private:
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
  if (auto fed = decoder.feed({bytes, body.size()}); !fed) return std::unexpected(fed.error());
  return decoder.finish();
}

}  // namespace adit::codec
