#pragma once

#include <functional>
#include <utility>

#include "loop/guard.hpp"

namespace adit::forward {

/// Takes a step that changes a file and memory. If an exception (no memory) ends it, the file may be ahead of
/// memory: then `restart` is called, so that the next life reads the file, and the exception is thrown on.
template <class Step>
decltype(auto) whole(const std::function<void()>& restart, Step&& step) {
  try {
    return std::forward<Step>(step)();
  } catch (...) {
    loop::guarded("restarting", restart);
    throw;
  }
}

}  // namespace adit::forward
