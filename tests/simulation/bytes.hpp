#pragma once

#include <string>

namespace adit::simulation {

/// One member of gzip.
std::string deflated(const std::string& bytes);
/// What a member of gzip holds, up to 16 MiB; "" where it is none.
std::string inflated(const std::string& bytes);
std::string base64(const std::string& bytes);

}  // namespace adit::simulation
