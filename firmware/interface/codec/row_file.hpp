#pragma once

#include <expected>
#include <string>
#include <string_view>
#include <utility>

#include "codec/row.hpp"

/// Small files of aditd and root programs, for messages and stored state. Each is one row as a JSON object
/// with the member "format": 1.
namespace adit::codec {

std::string write_row_file(const Row& row, const void* from);
/// A sentence about the first error, or "".
std::string read_row_file(const Row& row, void* into, std::string_view json);

template <class T>
std::string write_file(const T& row) {
  return write_row_file(T::kRow, &row);
}

/// Strict, in nested rows as well. Errors name the member: missing, unknown, not among its words, out of
/// bounds, or invalid.
template <class T>
std::expected<T, std::string> read_file(std::string_view json) {
  T row;
  if (auto fault = read_row_file(T::kRow, &row, json); !fault.empty())
    return std::unexpected(std::move(fault));
  return row;
}

}  // namespace adit::codec
