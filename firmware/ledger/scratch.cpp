#include "ledger/scratch.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <utility>

#include "ledger/files.hpp"

namespace adit::ledger {
namespace {

namespace fs = std::filesystem;

/// The folder it is in may be one that all programs share.
constexpr const char* kName = "adit-stand-in-";

/// Nothing where it is no folder of ours, or in use.
loop::FileDescriptor lock(const std::string& path) {
  loop::FileDescriptor folder(::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
  struct stat found{};
  if (!folder || ::fstat(folder.get(), &found) != 0 || found.st_uid != ::geteuid()) return {};
  if (::flock(folder.get(), LOCK_EX | LOCK_NB) != 0) return {};
  return folder;
}

}  // namespace

Scratch::Scratch(const std::string& below) {
  std::string path = below + "/" + kName + "XXXXXX";
  if (::mkdtemp(path.data()) == nullptr) return;
  path_ = std::move(path);
  lock_ = lock(path_);
}

Scratch::~Scratch() {
  std::error_code ignored;
  if (!path_.empty()) fs::remove_all(path_, ignored);
}

Scratch::Scratch(Scratch&& other) noexcept
    : path_(std::exchange(other.path_, "")), lock_(std::move(other.lock_)) {}

Scratch& Scratch::operator=(Scratch&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(lock_, other.lock_);
  return *this;
}

void sweep_scratch(const std::string& below) {
  std::error_code error;
  for (const std::string& path : beginning_with(below, kName)) {
    if (const auto ours = lock(path)) fs::remove_all(path, error);
  }
}

}  // namespace adit::ledger
