#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "codec/body_decoder.hpp"
#include "codec/cell_press.hpp"
#include "icd/chunked_bytes.hpp"
#include "icd/status.hpp"

namespace adit::codec {

/// Where the value at "msg.data" goes while the rest of the body is still arriving. Its refusals are 422
/// about msg.data, or 413 over the limit.
class BulkData {
 public:
  explicit BulkData(std::size_t most) : most_(most) {}

  /// A value at "msg.data" begins, of any kind: the first is taken, a second is refused.
  icd::Checked<void> appear();
  /// That value is bulk data of this form. `is_grid`: the body has said that it is a grid, so that its cells
  /// are pressed as they come, unless they begin as gzip does.
  void begin(DataForm form, bool is_grid) {
    form_ = form;
    is_grid_ = is_grid;
  }

  icd::Checked<void> append(std::span<const std::uint8_t> bytes);
  /// Whether so many more may be appended.
  icd::Checked<void> fits(std::uint64_t bytes) const;

  /// One element of an array: a whole number from -1 (as 255) to 255. `text` is how it stood in the body.
  icd::Checked<void> append_element(double value, std::string_view text);
  icd::Checked<void> append_element(std::uint8_t byte);
  /// So many of them, all the same.
  icd::Checked<void> append_elements(std::uint8_t byte, std::size_t count);
  /// An element that is no number.
  icd::Refusal bad_element(std::string_view got) const;

  DataForm form() const { return form_; }
  /// How many bytes take_some() would give.
  std::size_t held() const { return press_ ? press_->held() : bytes_.size(); }
  /// What has come since the last take_some(), but for the last few elements of an array.
  icd::ChunkedBytes take_some();
  /// All that take_some() has left, once, at the end.
  icd::Checked<icd::ChunkedBytes> take();
  /// What take_some() and take() gave are pressed cells.
  std::optional<PressedCells> pressed() const;

 private:
  icd::Checked<void> flush();

  std::size_t most_;
  bool appeared_ = false;
  DataForm form_ = DataForm::Absent;
  bool is_grid_ = false;
  std::optional<CellPress> press_;  // in the place of bytes_
  icd::ChunkedBytes bytes_;
  std::size_t came_ = 0;                       // before it was pressed
  std::array<std::uint8_t, 4096> elements_{};  // those that are not in bytes_ yet
  std::size_t waiting_ = 0;
};

}  // namespace adit::codec
