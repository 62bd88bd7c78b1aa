#pragma once

#include <cstdint>
#include <expected>
#include <string>

namespace adit::store {

/// Why a log could not be read or written.
struct Error {
  enum class Cause : std::uint8_t {
    Full,     // no room on the disk (ENOSPC, EDQUOT)
    NoWrite,  // the directory is read-only for this process (EROFS, EACCES, EPERM)
    Failing,  // the disk reports an error (EIO)
    InUse,    // another process has the log
    Newer,    // a later version wrote it
    TooLong,  // the record is longer than kMostBody
    Other,
  };
  Cause cause = Cause::Other;
  std::string what = "";  // a sentence
};

template <class T>
using Result = std::expected<T, Error>;

/// "PATH: No such file or directory", and its cause, of an errno.
std::unexpected<Error> failed(const std::string& path, int number);

}  // namespace adit::store
