#pragma once

#include <sys/resource.h>

#include <csignal>

namespace adit::spool {

/// Limits the size of files, as a full disk does, while it exists.
class NoFileAbove {
 public:
  explicit NoFileAbove(rlim_t size) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit small{size, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &small);
  }
  ~NoFileAbove() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  NoFileAbove(const NoFileAbove&) = delete;
  NoFileAbove& operator=(const NoFileAbove&) = delete;

 private:
  rlimit before_{};
  void (*handler_)(int);
};

}  // namespace adit::spool
