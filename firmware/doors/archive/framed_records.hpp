#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

namespace adit::archive {

/// Largest record: a tile that cannot be compressed.
inline constexpr std::size_t kLargestRecord = std::size_t{72} << 10;

/// A record in a file: a frame of store/, with a body (record_kinds.hpp) that must not be empty. It is valid
/// at any place of any file.
std::string framed(std::string_view body);

/// Calls `told` with the body of each complete record in `bytes`, in order. Skips damaged bytes up to the
/// next complete record or the end. Returns the number of damaged records, without a torn last one, which a
/// killed process leaves.
std::size_t for_each_record(std::string_view bytes, const std::function<void(std::string_view)>& told);

}  // namespace adit::archive
