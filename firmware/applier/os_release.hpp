#pragma once

#include <string>

namespace adit::applier {

/// VERSION_ID of os-release(5) without quotation marks; "" if absent.
std::string version_in(const std::string& path);

}  // namespace adit::applier
