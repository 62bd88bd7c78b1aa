#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include "codec/body_decoder.hpp"
#include "codec/gzip.hpp"
#include "icd/chunked_bytes.hpp"
#include "icd/status.hpp"

namespace adit::codec {

/// Compresses and checks a grid's cells on arrival, so that the end is quick and no raw cells are held.
class CellPress {
 public:
  void feed(std::span<const std::uint8_t> cells);

  std::size_t available() const { return gzipper_.available(); }
  /// The gzip member's bytes since the last take_some().
  icd::ChunkedBytes take_some() { return gzipper_.take_some(); }
  /// The rest of the member. Call once.
  icd::ChunkedBytes finish() { return gzipper_.finish(); }

  /// The first invalid cell by icd::check_cells(). Cells after it are not compressed.
  const icd::Checked<void>& check_result() const { return checked_; }

 private:
  Gzipper gzipper_{GzipStrategy::Runs};
  std::size_t fed_ = 0;
  icd::Checked<void> checked_;
};

/// Receives the value at "msg.data" while the body arrives. Errors: 422 about msg.data, 413 over the limit.
class BulkData {
 public:
  explicit BulkData(std::size_t most) : most_(most) {}

  /// Call when a value of any kind begins at "msg.data". A second one is an error.
  icd::Checked<void> appear();
  /// Call if the value is bulk data. `is_grid`: the body has declared a grid. Its cells are then compressed
  /// on arrival, unless they begin like gzip.
  void begin(DataForm form, bool is_grid) {
    form_ = form;
    is_grid_ = is_grid;
  }

  icd::Checked<void> append(std::span<const std::uint8_t> bytes);
  /// Whether `bytes` more are within the limit.
  icd::Checked<void> check_size(std::uint64_t bytes) const;

  /// Appends an array element: a whole number from -1 (stored as 255) to 255. `text`: its form in the body.
  icd::Checked<void> append_element(double value, std::string_view text);
  icd::Checked<void> append_element(std::uint8_t byte);
  icd::Checked<void> append_elements(std::uint8_t byte, std::size_t count);
  /// The refusal of an element that is not a number.
  icd::Refusal bad_element(std::string_view got) const;

  DataForm form() const { return form_; }
  std::size_t available() const { return press_ ? press_->available() : bytes_.size(); }
  /// Data since the last take_some(), except the last few array elements.
  icd::ChunkedBytes take_some() { return press_ ? press_->take_some() : std::move(bytes_); }
  /// The rest. Call once, at the end.
  icd::Checked<icd::ChunkedBytes> take_rest();
  /// Set if take_some() and take_rest() return compressed cells.
  std::optional<PressedCells> pressed_cells() const;

 private:
  icd::Checked<void> flush() { return append(std::span(elements_).first(std::exchange(waiting_, 0))); }

  std::size_t most_;
  bool appeared_ = false;
  DataForm form_ = DataForm::Absent;
  bool is_grid_ = false;
  std::optional<CellPress> press_;  // used instead of bytes_
  icd::ChunkedBytes bytes_;
  std::size_t came_ = 0;                       // bytes before compression
  std::array<std::uint8_t, 4096> elements_{};  // not yet in bytes_
  std::size_t waiting_ = 0;
};

}  // namespace adit::codec
