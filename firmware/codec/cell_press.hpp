#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "codec/gzip.hpp"
#include "icd/chunked_bytes.hpp"
#include "icd/status.hpp"

namespace adit::codec {

/// The cells of a grid, gzipped and checked as they arrive: when the last one is there little is left to do,
/// and none is held as it came.
class CellPress {
 public:
  void feed(std::span<const std::uint8_t> cells);

  /// How much take_some() would give.
  std::size_t held() const { return gzipper_.held(); }
  /// What has come of the gzip member since the last take_some().
  icd::ChunkedBytes take_some() { return gzipper_.take_some(); }
  /// The rest of the member, once.
  icd::ChunkedBytes finish() { return gzipper_.finish(); }

  /// Of icd::check_cells(): the first that no cell may be, and where. Nothing after it is pressed any more.
  const icd::Checked<void>& checked() const { return checked_; }

 private:
  Gzipper gzipper_{GzipStrategy::Runs};
  std::size_t fed_ = 0;
  icd::Checked<void> checked_;
};

}  // namespace adit::codec
