#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "codec/gzip.hpp"
#include "icd/chunked_bytes.hpp"
#include "icd/status.hpp"

namespace adit::codec {

/// Compresses and checks a grid's cells on arrival, so that little work is left at the end and raw cells are
/// not held.
class CellPress {
 public:
  void feed(std::span<const std::uint8_t> cells);

  /// Bytes that take_some() would return.
  std::size_t held() const { return gzipper_.held(); }
  /// The gzip member's bytes since the last take_some().
  icd::ChunkedBytes take_some() { return gzipper_.take_some(); }
  /// The rest of the member. Call once.
  icd::ChunkedBytes finish() { return gzipper_.finish(); }

  /// The first invalid cell by icd::check_cells(). Cells after it are not compressed.
  const icd::Checked<void>& checked() const { return checked_; }

 private:
  Gzipper gzipper_{GzipStrategy::Runs};
  std::size_t fed_ = 0;
  icd::Checked<void> checked_;
};

}  // namespace adit::codec
