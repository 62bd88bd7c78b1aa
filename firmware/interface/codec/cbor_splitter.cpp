#include "codec/cbor_splitter.hpp"

#include <algorithm>

#include "codec/cbor.hpp"
#include "codec/cbor_value.hpp"
#include "icd/sentence.hpp"
#include "icd/try.hpp"

namespace adit::codec {

CborSplitter::CborSplitter(Split split, DocumentLimits most, BulkData& data)
    : split_(split), data_(data), path_(split), rest_(most) {
  nests_.reserve(BodyDecoder::kDeepest);
}

icd::Checked<void> CborSplitter::feed(std::string_view bytes) {
  while (!bytes.empty()) {
    const auto taken = ADIT_TRY(piece_left_ > 0 ? string(bytes) : head(bytes));
    bytes.remove_prefix(taken);
    at_ += taken;
    if (!rest_.fits()) return std::unexpected(rest_.too_large());
  }
  return {};
}

icd::Checked<Value> CborSplitter::finish() {
  if (at_ == 0) return std::unexpected(fault_at(at_, "an empty document"));
  if (!whole_) return std::unexpected(fault_at(at_, "the document is cut short"));
  if (split_ == Split::Lists) return cbor_value_with_lists(rest_.take_text());
  Value root = cbor_value(rest_.text());
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
  if (head_.is_reserved()) return std::unexpected(fault("reserved additional information"));
  const Major major = head_.major();
  if (head_.indefinite() && (major == Major::Unsigned || major == Major::Negative || major == Major::Tag)) {
    return std::unexpected(fault("an indefinite length in an item that allows none"));
  }
  if (major == Major::Simple && head_.info() == 24 && head_.argument() < 32) {
    return std::unexpected(fault("a simple value below 32 in two bytes"));
  }
  return {};
}

icd::Checked<void> CborSplitter::item() {
  if (head_.is_break()) return end_of_nest();
  const bool is_key = is_at_key() && !leaves_out();
  if (is_key) {
    path_.begin_key();
    path_.end_key();  // in case the key is not a string
  }
  Destination into = is_key ? Destination::Key : Destination::Rest;
  if (elements()) {
    if (auto taken = element(); !taken) return taken;
  } else if (path_.is_at_data() && head_.major() != Major::Tag && !leaves_out()) {
    if (auto diverted = divert(); !diverted) return diverted;
    into = Destination::Data;
  }
  if (!elements() && into == Destination::Rest) {
    if (auto counted = count(); !counted) return counted;
  }
  switch (head_.major()) {
    case Major::Bytes:
    case Major::Text:
      return begin_string(into);
    case Major::Tag:
      return tag();
    case Major::Array:
    case Major::Map:
      return nest(head_.major());
    case Major::Simple:
      return simple();
    case Major::Unsigned:
    case Major::Negative:
      break;
  }
  keep(head_.raw());
  end_item();
  return {};
}

icd::Checked<void> CborSplitter::count() {
  if (!leaves_out() && !rest_.count()) return std::unexpected(rest_.too_many_values());
  return {};
}

icd::Checked<void> CborSplitter::simple() {
  constexpr std::uint8_t kFalse = 20;
  const bool assigned = head_.info() >= kFalse && head_.info() != 24;
  keep(assigned ? head_.raw() : "\xF7");
  end_item();
  return {};
}

icd::Checked<void> CborSplitter::tag() {
  constexpr std::string_view kInItsPlace = "\xF6";
  const bool changes = !is_remark(head_.argument()) && !leaves_out();
  if (changes && is_at_key() && is_reference(head_.argument()))
    return icd::unprocessable("a member's name: expected a string, got ", tag_that_changes(head_.argument()));
  if (changes && path_.is_at_data())
    return std::unexpected(bad_data("expected a byte string, got " + tag_that_changes(head_.argument())));
  if (changes) {
    keep(head_.raw());
    keep(kInItsPlace);
  }
  auto nested = nest(Major::Tag);
  if (nested && changes) left_out_of_ = nests_.size();
  return nested;
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
  end_item();
  return {};
}

icd::Checked<void> CborSplitter::end_of_nest() {
  if (nests_.empty() || !nests_.back().indefinite) return std::unexpected(fault("an unexpected break"));
  if (nests_.back().kind == Major::Map && !nests_.back().key_next) {
    return std::unexpected(fault("a key without its value"));
  }
  keep(head_.raw());
  path_.close();
  nests_.pop_back();
  end_item();
  return {};
}

/// Ends an item, and each tag or container that it completes.
void CborSplitter::end_item() {
  while (!nests_.empty()) {
    if (nests_.size() < elements_of_) elements_of_ = 0;
    if (nests_.size() < left_out_of_) left_out_of_ = 0;
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

bool CborSplitter::is_at_key() const {
  const Nest* const around = container();
  return around != nullptr && around->kind == Major::Map && around->key_next;
}

icd::Refusal CborSplitter::fault_at(std::size_t at, std::string_view what) {
  return {icd::Status::BadRequest, icd::sentence("not well-formed CBOR at byte ", at, ": ", what)};
}

}  // namespace adit::codec
