#pragma once

#include <string>
#include <vector>

#include "api/box.hpp"

namespace adit::box {

/// Libraries of the program, with versions at run time if known, else of the build.
std::vector<api::PartRow> parts();

/// "9f1c2ab0d3e4, GNU 12.2.0, Release"
std::string build_text();

}  // namespace adit::box
