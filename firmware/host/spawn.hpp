#pragma once

#include <sys/types.h>

#include <expected>
#include <string>
#include <vector>

namespace adit::host {

/// Starts a program (found by $PATH, or by its path) with nothing to read, and these two to write to. Gives
/// its number, or the errno. `environment`: "NAME=VALUE".
std::expected<pid_t, int> spawn(const std::vector<std::string>& words, int output, int errors,
                                const std::vector<std::string>& environment);

/// How it ended: "" where it exited 0, else "exit status 3" or "ended by signal 9".
std::string await_end(pid_t process);

}  // namespace adit::host
