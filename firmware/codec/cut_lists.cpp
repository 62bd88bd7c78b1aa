#include "codec/cut_lists.hpp"

#include <utility>

#include "icd/require.hpp"

namespace adit::codec {
namespace {

class CutList final : public List {
 public:
  CutList(SharedText text, Starts starts, Lists::Read read, std::size_t gap)
      : text_(std::move(text)), starts_(std::move(starts)), read_(read), gap_(gap) {}

  std::size_t size() const override { return starts_.empty() ? 0 : starts_.size() - 1; }
  icd::Checked<Value> element(std::size_t index) const override {
    icd::require(index < size());
    return read_(text_, starts_[index], starts_[index + 1] - gap_);
  }

 private:
  const SharedText text_;
  const Starts starts_;
  const Lists::Read read_;
  const std::size_t gap_;
};

}  // namespace

Value Lists::next() {
  icd::require(next_ < arrays_.size());
  return {std::make_shared<const CutList>(text_, std::move(arrays_[next_++]), read_, gap_)};
}

}  // namespace adit::codec
