#include "codec/cut_lists.hpp"

#include <utility>

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

}  // namespace adit::codec
