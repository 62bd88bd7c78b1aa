#pragma once

#include <cstdint>
#include <string_view>

#include "icd/chunked_bytes.hpp"

namespace adit::api {

/// A tar archive of plain files (POSIX.1-1988 ustar) with mode 0600 and no owner.
class Ustar {
 public:
  static constexpr std::size_t kLongestName = 100;

  /// `name`: a relative path of at most kLongestName bytes. `modified`: seconds since 1970.
  void add(std::string_view name, std::string_view body, std::int64_t modified);
  /// Returns the whole archive. Call once, after the last file.
  icd::ChunkedBytes finish();

 private:
  void append(std::string_view bytes);

  icd::ChunkedBytes archive_;
};

}  // namespace adit::api
