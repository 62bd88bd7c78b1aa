#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "api/run_view.hpp"

namespace adit::api {

/// A file of the support bundle.
struct BundleFile {
  std::string name, body;
};

/// Cuts the beginnings of the largest bodies, to one length, until all have at most `most` bytes. A cut body
/// begins with a line that says so.
void cut_to(std::vector<BundleFile>& files, std::size_t most);

/// Returns the files as a .tar.gz with the directory `folder`, at most kMostBundle bytes. Call it on a worker
/// thread, because it is slow.
inline constexpr std::size_t kMostBundle = 10'000'000;
std::string write_bundle(std::vector<BundleFile> files, const std::string& folder, Time now);

}  // namespace adit::api
