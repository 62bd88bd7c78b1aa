#include "codec/bulk_data.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "icd/rules.hpp"
#include "icd/sentence.hpp"
#include "icd/try.hpp"

namespace adit::codec {

void CellPress::feed(std::span<const std::uint8_t> cells) {
  if (!checked_) return;
  checked_ = icd::check_cells(cells, fed_);
  fed_ += cells.size();
  gzipper_.feed(checked_ ? cells : cells.first(icd::sound_cells(cells)));
}

icd::Checked<void> BulkData::appear() {
  if (std::exchange(appeared_, true)) {
    return icd::unprocessable("msg.data: given twice");
  }
  return {};
}

icd::Checked<void> BulkData::check_size(std::uint64_t bytes) const {
  if (bytes <= most_ - came_) return {};
  return icd::refuse(icd::Status::ContentTooLarge, "msg.data: larger than the limit of ", most_, " bytes");
}

icd::Checked<void> BulkData::append(std::span<const std::uint8_t> bytes) {
  if (auto fit = check_size(bytes.size()); !fit) return fit;
  if (bytes.empty()) return {};
  constexpr std::uint8_t kGzip = 0x1F;  // RFC 1952 2.3.1; a grid that begins so is compressed later
  if (came_ == 0 && is_grid_ && bytes.front() != kGzip) press_.emplace();
  came_ += bytes.size();
  if (press_) {
    press_->feed(bytes);
  } else {
    bytes_.append(bytes);
  }
  return {};
}

icd::Checked<void> BulkData::append_element(double value, std::string_view text) {
  const bool fits = value >= -1 && value <= 255 && value == std::floor(value);
  if (!fits) return std::unexpected(bad_element(text));
  return append_element(value < 0 ? std::uint8_t{255} : static_cast<std::uint8_t>(value));
}

icd::Checked<void> BulkData::append_element(std::uint8_t byte) {
  if (waiting_ == elements_.size()) {
    if (auto flushed = flush(); !flushed) return flushed;
  }
  elements_[waiting_++] = byte;
  return {};
}

icd::Checked<void> BulkData::append_elements(std::uint8_t byte, std::size_t count) {
  while (count > 0) {
    if (waiting_ == elements_.size()) {
      if (auto flushed = flush(); !flushed) return flushed;
    }
    const std::size_t some = std::min(count, elements_.size() - waiting_);
    std::fill_n(elements_.begin() + static_cast<std::ptrdiff_t>(waiting_), some, byte);
    waiting_ += some;
    count -= some;
  }
  return {};
}

icd::Refusal BulkData::bad_element(std::string_view got) const {
  constexpr std::size_t kLongest = 32;
  return {icd::Status::UnprocessableEntity,
          icd::sentence("msg.data[", came_ + waiting_, "]: expected an integer from -1 to 255, got ",
                        got.substr(0, kLongest), got.size() > kLongest ? "..." : "")};
}

icd::Checked<icd::ChunkedBytes> BulkData::take_rest() {
  ADIT_TRY(flush());
  return press_ ? press_->finish() : std::move(bytes_);
}

std::optional<PressedCells> BulkData::pressed_cells() const {
  if (!press_) return std::nullopt;
  return PressedCells{.count = came_, .checked = press_->check_result()};
}

}  // namespace adit::codec
