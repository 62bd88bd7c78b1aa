#pragma once

#include <string>

namespace adit::applier {

/// VERSION_ID of os-release(5), with or without quotation marks; "" where there is none.
std::string version_in(const std::string& path);

}  // namespace adit::applier
