#include "codec/cut_lists.hpp"

#include <utility>

#include "codec/cbor.hpp"
#include "icd/require.hpp"

namespace adit::codec {
namespace {

class CutList final : public List {
 public:
  CutList(SharedText text, Starts starts, const ListFormat& format)
      : text_(std::move(text)), starts_(std::move(starts)), format_(format) {}

  std::size_t size() const override { return starts_.empty() ? 0 : starts_.size() - 1; }
  icd::Checked<Value> element(std::size_t index) const override {
    icd::require(index < size());
    return format_.element(text_, starts_[index], end_of(index));
  }
  bool reals(std::size_t index, std::span<const std::string_view> names,
             std::span<double> into) const override {
    icd::require(index < size() && names.size() == into.size());
    const std::string_view text = *text_;
    return format_.reals(text.substr(starts_[index], end_of(index) - starts_[index]), names, into);
  }

 private:
  std::size_t end_of(std::size_t index) const { return starts_[index + 1] - format_.gap; }

  const SharedText text_;
  const Starts starts_;
  const ListFormat& format_;
};

}  // namespace

Value list_of(const SharedText& text, Starts starts, const ListFormat& format) {
  return {std::make_shared<const CutList>(text, std::move(starts), format)};
}

Value Lists::next() {
  icd::require(next_ < arrays_.size());
  return list_of(text_, std::move(arrays_[next_++]), format_);
}

namespace {

/// Walks well-formed items. BodyDecoder::kDeepest limits the recursion.
class CborCutter {
 public:
  CborCutter(std::string_view text, std::size_t at, Cut& cut) : text_(text), at_(at), cut_(cut) {}

  /// Copies an item without its outermost arrays.
  void keep() {
    ++cut_.values;
    const std::size_t begin = at_;
    const CborHead head = next_head();
    if (head.major() == Major::Array) {
      cut_.rest += '\x80';
      cut_.arrays.push_back(starts_in(head));
    } else if (head.major() == Major::Map) {
      cut_.rest += head.raw();
      each(head, [this] { keep_member(); });
      if (head.indefinite()) cut_.rest += '\xFF';
    } else {
      skip_rest(head);
      cut_.rest += text_.substr(begin, at_ - begin);
    }
  }

 private:
  CborHead next_head() {
    CborHead head;
    at_ += head.next(text_.substr(at_));
    return head;
  }

  /// Visits each element, pair or chunk.
  template <class Visit>
  void each(const CborHead& head, const Visit& visit) {
    if (!head.indefinite()) {
      for (std::uint64_t left = head.argument(); left > 0; --left) visit();
      return;
    }
    while (text_[at_] != '\xFF') visit();
    ++at_;
  }

  void keep_member() {
    keep();
    --cut_.values;  // names are not counted
    keep();
  }

  Starts starts_in(const CborHead& head) {
    Starts starts;
    each(head, [&] {
      starts.push_back(static_cast<std::uint32_t>(at_));  // the text is at most a few MB
      skip();
    });
    if (starts.empty()) return starts;
    starts.push_back(static_cast<std::uint32_t>(at_ - (head.indefinite() ? 1 : 0)));
    return starts;
  }

  void skip() { skip_rest(next_head()); }

  void skip_rest(const CborHead& head) {
    switch (head.major()) {
      case Major::Bytes:
      case Major::Text:
        if (head.indefinite()) return each(head, [this] { skip(); });
        at_ += head.argument();
        return;
      case Major::Array:
        return each(head, [this] { skip(); });
      case Major::Map:
        return each(head, [this] { skip(), skip(); });
      case Major::Tag:
        return skip();
      case Major::Unsigned:
      case Major::Negative:
      case Major::Simple:
        return;
    }
  }

  std::string_view text_;
  std::size_t at_;
  Cut& cut_;
};

}  // namespace

Cut cut_cbor(std::string_view text, std::size_t begin) {
  Cut cut;
  CborCutter(text, begin, cut).keep();
  return cut;
}

}  // namespace adit::codec
