#pragma once

#include <cstddef>
#include <utility>

namespace adit::icd {

/// Converts to any type; only for count_of_members().
struct AnyValue {
  template <class T>
  operator T() const;  // NOLINT(google-explicit-constructor): a member's value
};

template <class Struct, std::size_t... i>
consteval bool has_members(std::index_sequence<i...> /*indices*/) {
  return requires { Struct{(static_cast<void>(i), AnyValue{})...}; };
}

/// The number of non-static members of an aggregate without base classes and built-in arrays. A table of a
/// struct's members compares its size with it, so that the compiler names a member without a row.
template <class Struct, std::size_t known = 0>
consteval std::size_t count_of_members() {
  if constexpr (has_members<Struct>(std::make_index_sequence<known + 1>()))
    return count_of_members<Struct, known + 1>();
  else
    return known;
}

}  // namespace adit::icd
