#pragma once

#include <cstddef>
#include <span>
#include <string_view>

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
  /// The numbers of an element that is an object of these members alone, in this order, each a finite number.
  /// False if the element is anything else: then element() tells what it is. A list of points or colors is
  /// read so at a fifth of the cost.
  virtual bool reals(std::size_t index, std::span<const std::string_view> names,
                     std::span<double> into) const = 0;
};

inline constexpr std::size_t kMostOutsideLists = 20'000;  // values of a document, or of a list's element

}  // namespace adit::codec
