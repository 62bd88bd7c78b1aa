#include "store/error.hpp"

#include <cerrno>

#include "loop/regular_file.hpp"

namespace adit::store {
namespace {

Error::Cause cause_of(int number) {
  switch (number) {
    case ENOSPC:
    case EDQUOT:
    case EFBIG:
      return Error::Cause::Full;
    case EROFS:
    case EACCES:
    case EPERM:
      return Error::Cause::NoWrite;
    case EIO:
      return Error::Cause::Failing;
    default:
      return Error::Cause::Other;
  }
}

}  // namespace

std::unexpected<Error> failed(const std::string& path, int number) {
  return std::unexpected(Error{cause_of(number), path + ": " + loop::text_of(number)});
}

}  // namespace adit::store
