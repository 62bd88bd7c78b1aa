#pragma once

#include <string>
#include <vector>

#include "page/box.hpp"

namespace adit::gateway {

/// The libraries in the program: the version of each as it tells it now, or else as of the build.
std::vector<page::PartRow> parts();

/// "9f1c2ab0d3e4, GNU 12.2.0, Release"
std::string build_text();

}  // namespace adit::gateway
