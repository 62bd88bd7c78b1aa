#include "codec/cbor_splitter.hpp"

#include <algorithm>

#include "codec/cbor_value.hpp"
#include "icd/sentence.hpp"

namespace adit::codec {
namespace {

/// A tag that says what a value is for and leaves it what it is: date and time as text or number, how it is
/// to be written in other formats, kinds of text, and that this is CBOR (RFC 8949 3.4).
bool is_remark(std::uint64_t tag) {
  return tag <= 1 || (tag >= 21 && tag <= 23) || (tag >= 32 && tag <= 36) || tag == 55799;
}

}  // namespace

CborSplitter::CborSplitter(Split split, Most most, BulkData& data)
    : split_(split), most_(most), data_(data), path_(split) {
  nests_.reserve(BodyDecoder::kDeepest);
}

icd::Checked<void> CborSplitter::feed(std::string_view bytes) {
  while (!bytes.empty()) {
    const auto taken = piece_left_ > 0 ? string(bytes) : head(bytes);
    if (!taken) return std::unexpected(taken.error());
    bytes.remove_prefix(*taken);
    at_ += *taken;
    if (rest_.size() > most_.text) return std::unexpected(text_too_large(most_.text));
  }
  return {};
}

icd::Checked<Value> CborSplitter::finish() {
  if (at_ == 0) return std::unexpected(fault_at(at_, "an empty document"));
  if (!whole_) return std::unexpected(fault_at(at_, "the document is cut short"));
  if (split_ == Split::Lists) return cbor_value_with_lists(std::move(rest_));
  Value root = cbor_value(rest_);
  if (data_.form() != DataForm::Absent) mark_split_out(root);
  return root;
}

icd::Checked<std::size_t> CborSplitter::head(std::string_view in) {
  if (whole_) return std::unexpected(fault_at(at_, "bytes after the document"));
  if (elements() && head_.empty() && nests_.size() == elements_of_) {
    if (auto taken = plain_elements(in); !taken || *taken > 0) return taken;
  }
  if (head_.empty()) head_at_ = at_;
  const std::size_t taken = head_.next(in);
  if (!head_.complete()) return taken;
  auto good = check_head();
  if (good) good = string_ ? chunk_of_string() : item();
  if (!good) return std::unexpected(good.error());
  head_.clear();
  return taken;
}

icd::Checked<void> CborSplitter::check_head() const {
  if (head_.reserved()) return std::unexpected(fault("reserved additional information"));
  const Major major = head_.major();
  if (head_.indefinite() && (major == Major::Unsigned || major == Major::Negative || major == Major::Tag)) {
    return std::unexpected(fault("an indefinite length where there is none"));
  }
  if (major == Major::Tag) {
    if (auto known = check_tag(); !known) return known;
  }
  if (major == Major::Simple && head_.info() == 24 && head_.argument() < 32) {
    return std::unexpected(fault("a simple value below 32 in two bytes"));
  }
  return {};
}

icd::Checked<void> CborSplitter::check_tag() const {
  const std::uint64_t tag = head_.argument();
  if (is_remark(tag)) return {};
  return icd::unprocessable(
      "byte ", head_at_, ": CBOR tag ", tag,
      " changes the meaning of what it stands before; expected none, or one of 0, 1, 21 to "
      "23, 32 to 36 and 55799, which do not");
}

icd::Checked<void> CborSplitter::item() {
  if (head_.is_break()) return end_of_nest();
  if (at_key()) path_.key({});  // until it turns out to be a string
  Into into = at_key() ? Into::Key : Into::Rest;
  if (elements()) {
    if (auto taken = element(); !taken) return taken;
  } else if (path_.at_data() && head_.major() != Major::Tag) {
    if (auto diverted = divert(); !diverted) return diverted;
    into = Into::Data;
  }
  if (!elements() && into == Into::Rest) {
    if (auto counted = count(); !counted) return counted;
  }
  switch (head_.major()) {
    case Major::Bytes:
    case Major::Text:
      return begin_string(into);
    case Major::Array:
    case Major::Map:
    case Major::Tag:
      return nest(head_.major());
    case Major::Simple:
      return simple();
    case Major::Unsigned:
    case Major::Negative:
      break;
  }
  keep(head_.raw());
  item_ended();
  return {};
}

icd::Checked<void> CborSplitter::count() {
  if (++values_ > most_.values) return std::unexpected(too_many_values(most_.values));
  return {};
}

icd::Checked<void> CborSplitter::simple() {
  constexpr std::uint8_t kFalse = 20;
  const bool assigned = head_.info() >= kFalse && head_.info() != 24;
  keep(assigned ? head_.raw() : "\xF7");
  item_ended();
  return {};
}

icd::Checked<void> CborSplitter::nest(Major kind) {
  if (nests_.size() == BodyDecoder::kDeepest) {
    return std::unexpected(fault(icd::sentence("nested deeper than ", BodyDecoder::kDeepest)));
  }
  if (kind != Major::Tag) {
    keep(head_.raw());
    path_.open();
  }
  nests_.push_back({.kind = kind,
                    .indefinite = head_.indefinite(),
                    .left = kind == Major::Tag ? 1 : head_.argument(),
                    .key_next = kind == Major::Map});
  if (kind == Major::Tag || head_.indefinite() || head_.argument() > 0) return {};
  path_.close();
  nests_.pop_back();
  item_ended();
  return {};
}

icd::Checked<void> CborSplitter::end_of_nest() {
  if (nests_.empty() || !nests_.back().indefinite)
    return std::unexpected(fault("a break where none belongs"));
  if (nests_.back().kind == Major::Map && !nests_.back().key_next) {
    return std::unexpected(fault("a key without its value"));
  }
  keep(head_.raw());
  path_.close();
  nests_.pop_back();
  item_ended();
  return {};
}

/// An item is whole, and with it each tag and each container whose last item it was.
void CborSplitter::item_ended() {
  while (!nests_.empty()) {
    if (nests_.size() < elements_of_) elements_of_ = 0;
    Nest& inner = nests_.back();
    if (inner.kind == Major::Map && inner.key_next) {
      inner.key_next = false;
      return;
    }
    inner.key_next = inner.kind == Major::Map;
    if (inner.indefinite || --inner.left > 0) return;
    if (inner.kind != Major::Tag) path_.close();
    nests_.pop_back();
  }
  whole_ = true;
}

const CborSplitter::Nest* CborSplitter::container() const {
  const auto found =
      std::find_if(nests_.rbegin(), nests_.rend(), [](const Nest& nest) { return nest.kind != Major::Tag; });
  return found == nests_.rend() ? nullptr : &*found;
}

bool CborSplitter::at_key() const {
  const Nest* const around = container();
  return around != nullptr && around->kind == Major::Map && around->key_next;
}

icd::Refusal CborSplitter::fault_at(std::size_t at, std::string_view what) {
  return {icd::Status::BadRequest, icd::sentence("not well-formed CBOR at byte ", at, ": ", what)};
}

}  // namespace adit::codec
