#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

namespace adit::archive {

/// The largest that is written: a tile that nothing makes smaller.
inline constexpr std::size_t kLargestRecord = std::size_t{72} << 10;

/// A record as it stands in a file: four bytes that begin each, its length and its CRC-32 (RFC 1952 8), 4
/// bytes each and little-endian, and what it says (said.hpp), which is not empty.
std::string framed(std::string_view said);

/// Calls `told` with the body of each complete record in `bytes`, in order. Skips damaged bytes up to the
/// next complete record, or to the end. Returns the number of damaged records, without a torn one that a
/// killed process leaves.
std::size_t for_each_record(std::string_view bytes, const std::function<void(std::string_view)>& told);

}  // namespace adit::archive
