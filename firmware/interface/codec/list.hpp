#pragma once

#include <cstddef>
#include <span>
#include <string_view>

#include "codec/value.hpp"
#include "icd/status.hpp"

namespace adit::codec {

/// An array left as text. Each element is parsed on request and not stored.
class List {
 public:
  List() = default;
  virtual ~List() = default;
  List(const List&) = delete;
  List& operator=(const List&) = delete;

  virtual std::size_t size() const = 0;
  /// `index` must be below size(). Error 413: more than kMostOutsideLists values outside its own lists.
  virtual icd::Checked<Value> element(std::size_t index) const = 0;
  /// Reads an element that is an object of exactly these members, in this order, with finite numbers. False:
  /// another element, which element() then describes. Reads points and colors at a fifth of the cost.
  virtual bool reals(std::size_t index, std::span<const std::string_view> names,
                     std::span<double> into) const = 0;
};

inline constexpr std::size_t kMostOutsideLists = 20'000;  // values of a document, or of a list's element

}  // namespace adit::codec
