// The CBOR splitter's strings, and the map's data, which it splits off.
#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "codec/cbor.hpp"
#include "codec/cbor_splitter.hpp"
#include "codec/splitter.hpp"
#include "icd/sentence.hpp"
#include "icd/try.hpp"

namespace adit::codec {
namespace {

std::string_view element_kind(const CborHead& head) {
  constexpr std::array<std::string_view, 8> kKinds = {
      // in the order of Major
      "a whole number", "a whole number",           "a byte string", "a string", "an array",
      "an object",      "a value under a CBOR tag", "null"};
  const bool boolean = head.major() == Major::Simple && (head.info() == 20 || head.info() == 21);
  return boolean ? "true or false" : kKinds[std::to_underlying(head.major())];
}

std::span<const std::uint8_t> bytes_of(std::string_view run) {
  return {reinterpret_cast<const std::uint8_t*>(run.data()), run.size()};
}

}  // namespace

icd::Checked<void> CborSplitter::divert() {
  if (auto only = data_.appear(); !only) return only;
  switch (head_.major()) {
    case Major::Bytes:
      rest_.add("\xF6");
      data_.begin(DataForm::ByteString, path_.is_grid());
      break;
    case Major::Array:
      rest_.add("\xF6");
      data_.begin(DataForm::Integers, path_.is_grid());
      elements_of_ = nests_.size() + 1;
      break;
    case Major::Text:  // ICD 6.3 (b); refused here, because it may be too long for the rest
      return std::unexpected(bad_data("expected a byte string, got a string"));
    default:
      break;  // the reader refuses it
  }
  return {};
}

icd::Checked<void> CborSplitter::element() {
  const Major major = head_.major();
  if (major == Major::Unsigned && head_.argument() <= 255) {
    return data_.append_element(static_cast<std::uint8_t>(head_.argument()));
  }
  if (major == Major::Unsigned) {
    return std::unexpected(data_.bad_element(std::to_string(head_.argument())));
  }
  if (major == Major::Negative) {
    const double value = -1 - static_cast<double>(head_.argument());
    return data_.append_element(value, icd::number_text(value));
  }
  if (major == Major::Simple && head_.info() >= 25 && head_.info() <= 27) {
    return data_.append_element(head_.number(), icd::number_text(head_.number()));
  }
  if (major == Major::Tag && is_remark(head_.argument())) return {};
  return std::unexpected(data_.bad_element(element_kind(head_)));
}

/// Fast path for elements in their usual form. Leaves the last one of a known length, which ends the array.
icd::Checked<std::size_t> CborSplitter::plain_elements(std::string_view in) {
  std::string_view left = in;
  Nest& list = nests_.back();
  while (list.indefinite || list.left > 1) {
    constexpr auto kAny = std::numeric_limits<std::uint64_t>::max();
    const auto elements = take_plain_cbor_elements(left, list.indefinite ? kAny : list.left - 1);
    if (!elements) break;
    ADIT_TRY(data_.append_elements(elements->value, elements->count));
    if (!list.indefinite) list.left -= elements->count;
  }
  return in.size() - left.size();
}

icd::Checked<void> CborSplitter::begin_string(Destination into) {
  string_ = {.kind = head_.major(), .chunked = head_.indefinite(), .into = into};
  if (into != Destination::Data) keep(head_.raw());
  return string_->chunked ? icd::Checked<void>{} : begin_piece();
}

icd::Checked<void> CborSplitter::chunk_of_string() {
  if (!head_.is_break() && (head_.indefinite() || string_->kind != head_.major())) {
    return std::unexpected(fault("a string in chunks holds something else"));
  }
  if (string_->into != Destination::Data) {
    if (auto counted = count(); !counted) return counted;
    keep(head_.raw());
  }
  if (!head_.is_break()) return begin_piece();
  end_string();
  return {};
}

icd::Checked<void> CborSplitter::begin_piece() {
  piece_left_ = head_.argument();
  if (string_->into == Destination::Data) {
    if (auto fit = data_.check_size(piece_left_); !fit) return fit;
  }
  return piece_left_ == 0 ? end_of_piece() : icd::Checked<void>{};
}

icd::Checked<std::size_t> CborSplitter::string(std::string_view in) {
  const std::string_view run = in.substr(0, std::min<std::uint64_t>(piece_left_, in.size()));
  if (string_->kind == Major::Text) {
    if (const auto bad = utf8_.feed(run)) {
      return std::unexpected(fault_at(at_ + *bad, "a text that is not UTF-8"));
    }
  }
  if (string_->into == Destination::Data) {
    ADIT_TRY(data_.append(bytes_of(run)));
  } else {
    keep(run);
  }
  if (string_->into == Destination::Rest) path_.text(run);
  if (string_->into == Destination::Key) path_.key_text(run);
  piece_left_ -= run.size();
  if (piece_left_ == 0) {
    ADIT_TRY(end_of_piece());
  }
  return run.size();
}

icd::Checked<void> CborSplitter::end_of_piece() {
  // RFC 8949 3.2.3: a chunk must not split a character.
  if (!utf8_.complete()) return std::unexpected(fault("a text that ends within a character"));
  if (!string_->chunked) end_string();
  return {};
}

void CborSplitter::end_string() {
  if (string_->into == Destination::Key) path_.end_key();
  string_.reset();
  end_item();
}

}  // namespace adit::codec
