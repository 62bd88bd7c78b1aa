#pragma once

#include <cstddef>

#include "codec/value.hpp"
#include "icd/status.hpp"

namespace adit::codec {

/// An array that was left as text: each element is parsed when it is asked for, and nowhere but with who
/// asks.
class List {
 public:
  List() = default;
  virtual ~List() = default;
  List(const List&) = delete;
  List& operator=(const List&) = delete;

  virtual std::size_t size() const = 0;
  /// `index` is below size(). 413: more than kMostOutsideLists values beside its own lists.
  virtual icd::Checked<Value> element(std::size_t index) const = 0;
};

inline constexpr std::size_t kMostOutsideLists = 20'000;  // values of a document, or of a list's element

}  // namespace adit::codec
