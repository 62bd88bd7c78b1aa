#pragma once

#include <cstdint>
#include <expected>
#include <string>

namespace adit::store {

/// Why a log could not be read or written.
struct Error {
  enum class Cause : std::uint8_t {
    Full,     // the disk is full (ENOSPC, EDQUOT)
    NoWrite,  // this process may not write the directory (EROFS, EACCES, EPERM)
    Failing,  // the disk reports an error (EIO)
    InUse,    // another process has locked the log
    Newer,    // a later version wrote it
    TooLong,  // a record is longer than kMostBody
    Other,
  };
  Cause cause = Cause::Other;
  std::string what = "";  // a sentence
};

template <class T>
using Result = std::expected<T, Error>;

/// "PATH: No such file or directory", with the cause of errno `number`.
std::unexpected<Error> failed(const std::string& path, int number);

}  // namespace adit::store
