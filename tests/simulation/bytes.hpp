#pragma once

#include <string>

namespace adit::simulation {

/// Compresses into one gzip member.
std::string deflated(const std::string& bytes);
/// Decompresses one gzip member of at most 16 MiB; "" if it is not a gzip member.
std::string inflated(const std::string& bytes);
std::string base64(const std::string& bytes);

}  // namespace adit::simulation
