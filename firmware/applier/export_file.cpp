#include "applier/export_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

#include "host/files.hpp"
#include "host/service.hpp"
#include "loop/regular_file.hpp"
#include "spare/sealed.hpp"

namespace adit::applier {
namespace {

using loop::FileDescriptor;

FileDescriptor open_folder(const std::string& path) {
  return FileDescriptor(open(path.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
}

std::unexpected<std::string> failed(const std::string& name, int error) {
  std::string why = host::trouble(name, error);
  if (error == ENOSPC || error == EDQUOT) why = "the stick is full";
  if (error == EROFS) why = "the stick is write-protected, or its file system is damaged";
  return std::unexpected(std::move(why));
}

/// 0, or errno.
int put(int folder, const std::string& name, const std::string& bytes) {
  const FileDescriptor file(
      openat(folder, kUnfinished, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, host::kForAll));
  if (!file) return errno;
  if (loop::write_all(file.get(), bytes, 0) != 0 || fsync(file.get()) != 0) return errno;
  if (renameat(folder, kUnfinished, folder, name.c_str()) != 0) return errno;
  return fsync(folder) == 0 && syncfs(folder) == 0 ? 0 : errno;
}

}  // namespace

std::expected<void, std::string> write_export(const std::string& folder, const std::string& name,
                                              const std::string& bytes) {
  const FileDescriptor in = open_folder(folder);
  if (!in) return failed("the stick", errno);
  unlinkat(in.get(), kUnfinished, 0);
  const int error = put(in.get(), name, bytes);
  if (error == 0) return {};
  unlinkat(in.get(), kUnfinished, 0);
  return failed(name, error);
}

std::expected<std::string, std::string> read_export(const std::string& folder, const std::string& name) {
  const FileDescriptor in = open_folder(folder);
  const FileDescriptor file =
      in ? loop::open_regular(name, O_RDONLY | O_NOFOLLOW, in.get()) : FileDescriptor();
  if (!file) return failed(name, errno);
  auto bytes = loop::read_all(file, spare::kLargestExport);
  if (bytes) return std::move(*bytes);
  if (bytes.error() == EFBIG) return std::unexpected(name + ": the file is larger than an export may be");
  return failed(name, bytes.error());
}

}  // namespace adit::applier
