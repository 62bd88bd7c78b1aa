#pragma once

#include <version>  // brings libstdc++'s configuration, and so its assertions

// What a failed assertion of the standard library says (_GLIBCXX_ASSERTIONS): file, line and condition, as
// before, but not the name of the function. Those names are long, one for each type that a template is used
// with: 100 kB of aditd.
#ifdef __glibcxx_assert_impl
#undef __glibcxx_assert_impl
#define __glibcxx_assert_impl(condition)                            \
  if (__builtin_expect(!bool(condition), false)) {                  \
    __glibcxx_constexpr_assert(false);                              \
    std::__glibcxx_assert_fail(__FILE__, __LINE__, "", #condition); \
  }
#endif
