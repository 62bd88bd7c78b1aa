#pragma once

#include <string.h>  // strverscmp, of glibc

#include <string>

namespace adit::icd {

/// The order of names that people read: numbers in them by their value, r2 before r10.
struct NaturalOrder {
  bool operator()(const std::string& one, const std::string& other) const {
    const int difference = strverscmp(one.c_str(), other.c_str());
    return difference != 0 ? difference < 0 : one < other;
  }
};

}  // namespace adit::icd
