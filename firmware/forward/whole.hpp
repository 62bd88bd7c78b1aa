#pragma once

#include <functional>
#include <utility>

#include "loop/guard.hpp"

namespace adit::forward {

/// Takes a step that a file and memory both know of. Where an exception (no memory) ends it, the file may be
/// ahead of memory: then `anew` is called, so that another life reads the file, and the exception goes on.
template <class Step>
decltype(auto) whole(const std::function<void()>& anew, Step&& step) {
  try {
    return std::forward<Step>(step)();
  } catch (...) {
    loop::guarded("beginning anew", anew);
    throw;
  }
}

}  // namespace adit::forward
