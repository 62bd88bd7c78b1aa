#include "applier/bundle_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

#include "host/files.hpp"
#include "icd/sentence.hpp"
#include "icd/try.hpp"
#include "loop/regular_file.hpp"
#include "update/messages.hpp"

namespace adit::applier {
namespace {

std::expected<loop::FileDescriptor, std::string> open_plain(const std::string& path,
                                                            const std::string& name) {
  loop::FileDescriptor file = loop::open_regular(path, O_RDONLY | O_NOFOLLOW);
  struct stat status{};
  if (!file || fstat(file.get(), &status) != 0) return std::unexpected(host::trouble(name, errno));
  if (status.st_size == 0) return std::unexpected(name + ": expected a bundle, got an empty file");
  if (std::cmp_greater(status.st_size, update::kLargestBundle)) {
    return std::unexpected(
        icd::sentence(name, ": expected at most ", update::kLargestBundle, " bytes, got ", status.st_size));
  }
  return file;
}

/// Gives the file to this user, so that no other user can open it. The kernel grants the lease only if no
/// process has the file open for writing (fcntl(2)).
std::expected<void, std::string> make_ours(const loop::FileDescriptor& file, const std::string& name) {
  if (fchown(file.get(), geteuid(), getegid()) != 0 || fchmod(file.get(), S_IRUSR) != 0)
    return std::unexpected(host::trouble(name, errno));
  if (fcntl(file.get(), F_SETLEASE, F_RDLCK) != 0) {
    return std::unexpected(errno == EAGAIN ? name + ": another program is writing to it"
                                           : host::trouble(name, errno));
  }
  fcntl(file.get(), F_SETLEASE, F_UNLCK);
  return {};
}

}  // namespace

std::expected<BundleFile, std::string> BundleFile::take(host::UntrustedFolder& folder,
                                                        const std::string& name) {
  const std::string path = folder.path_by_descriptor() + '/' + name;
  auto file = open_plain(path, name);
  const auto gone = folder.remove(name);
  if (!file) return std::unexpected(file.error());
  if (!gone) return std::unexpected(gone.error());
  ADIT_TRY(make_ours(*file, name));
  return BundleFile(std::move(*file));
}

std::expected<BundleFile, std::string> BundleFile::open(const std::string& path) {
  auto file = ADIT_TRY(open_plain(path, path.substr(path.rfind('/') + 1)));
  return BundleFile(std::move(file));
}

std::string BundleFile::path() const {
  return icd::sentence("/proc/", getpid(), "/fd/", file_.get());
}

}  // namespace adit::applier
