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

/// Tells what the whole records in `bytes` say, in order. What is damaged is passed over up to the next whole
/// record; in a file that is damaged all over, the rest is. Returns the number of damaged records: not of
/// torn ones, which a death leaves.
std::size_t for_each_record(std::string_view bytes, const std::function<void(std::string_view)>& told);

}  // namespace adit::archive
