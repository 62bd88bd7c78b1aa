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

/// Cuts the largest bodies from their beginning, to the same length each, until all together are of at most
/// `most` bytes; each that is cut begins with a line that says so.
void cut_to(std::vector<BundleFile>& files, std::size_t most);

/// The files as a .tar.gz, in the folder `folder`, of at most kMostBundle bytes. Slow: for a worker.
inline constexpr std::size_t kMostBundle = 10'000'000;
std::string write_bundle(std::vector<BundleFile> files, const std::string& folder, Time now);

}  // namespace adit::api
