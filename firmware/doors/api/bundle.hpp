#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "api/run_view.hpp"
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

struct BundleFile {
  std::string name, body;
};

/// Cuts the beginnings of the largest bodies, to one length, until all have at most `most` bytes. A cut body
/// begins with a line that says so.
void cut_to(std::vector<BundleFile>& files, std::size_t most);

/// The files as a .tar.gz with the directory `folder`, at most kMostBundle bytes. Slow: call it on a worker.
inline constexpr std::size_t kMostBundle = 10'000'000;
std::string write_bundle(std::vector<BundleFile> files, const std::string& folder, Time now);

}  // namespace adit::api
