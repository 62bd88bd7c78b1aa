#include "store/error.hpp"

#include <cerrno>
#include <system_error>

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
  return std::unexpected(Error{cause_of(number), path + ": " + std::system_category().message(number)});
}

}  // namespace adit::store
