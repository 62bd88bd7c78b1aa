#pragma once

#include <cstdint>
#include <expected>
#include <string>
#include <string_view>
#include <utility>

#include "codec/row.hpp"

/// The small files by which aditd and the programs with more rights speak, and in which these keep what
/// lasts: each is one row, as an object of JSON with the number of its format.
namespace adit::codec {

/// The member that has the number, and the one number that is read.
struct FileFormat {
  std::string_view member = "version";
  std::int64_t number = 1;
};

std::string write_row_file(const Row& row, const void* from, const FileFormat& format);
/// A sentence about the first thing that is not as it must be; "": there is none.
std::string read_row_file(const Row& row, void* into, std::string_view json, const FileFormat& format);

template <class T>
std::string write_file(const T& row, const FileFormat& format) {
  return write_row_file(T::kRow, &row, format);
}

/// Strict, in rows within rows too: a member that is missing or unknown, a value that is not among its
/// member's words or within its bounds, and one that is not what it must be, are errors that name it.
template <class T>
std::expected<T, std::string> read_file(std::string_view json, const FileFormat& format) {
  T row;
  if (auto fault = read_row_file(T::kRow, &row, json, format); !fault.empty())
    return std::unexpected(std::move(fault));
  return row;
}

}  // namespace adit::codec
