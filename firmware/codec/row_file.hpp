#pragma once

#include <expected>
#include <string>
#include <string_view>
#include <utility>

#include "codec/row.hpp"

/// The small files by which aditd and the programs with more rights speak, and in which these keep what
/// lasts: each is one row, as an object of JSON with the member "format": 1.
namespace adit::codec {

std::string write_row_file(const Row& row, const void* from);
/// A sentence about the first thing that is not as it must be; "": there is none.
std::string read_row_file(const Row& row, void* into, std::string_view json);

template <class T>
std::string write_file(const T& row) {
  return write_row_file(T::kRow, &row);
}

/// Strict, in rows within rows too: a member that is missing or unknown, a value that is not among its
/// member's words or within its bounds, and one that is not what it must be, are errors that name it.
template <class T>
std::expected<T, std::string> read_file(std::string_view json) {
  T row;
  if (auto fault = read_row_file(T::kRow, &row, json); !fault.empty())
    return std::unexpected(std::move(fault));
  return row;
}

}  // namespace adit::codec
