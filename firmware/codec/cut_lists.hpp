#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "codec/list.hpp"

/// Well-formed documents whose arrays stay text: a large message is nowhere in memory as a tree.
namespace adit::codec {

using SharedText = std::shared_ptr<const std::string>;
/// Where each element of an array begins in its text, and then where the next would; none: it is empty.
using Starts = std::vector<std::uint32_t>;

/// The value at `begin` of a text without its outermost arrays, for which empty ones stand.
struct Cut {
  std::string rest;
  std::vector<Starts> arrays;  // as they come
  std::size_t values = 0;      // in `rest`
};
Cut cut_cbor(std::string_view text, std::size_t begin);

/// How the elements of a format are read.
struct ListFormat {
  icd::Checked<Value> (*element)(const SharedText& text, std::size_t begin, std::size_t end);
  bool (*reals)(std::string_view element, std::span<const std::string_view> names, std::span<double> into);
  std::size_t gap;  // bytes between two elements
};

/// A List of these elements. `format` must outlive it.
Value list_of(const SharedText& text, Starts starts, const ListFormat& format);

/// What stands for the arrays of a Cut, one after the other.
class Lists {
 public:
  Lists(SharedText text, std::vector<Starts> arrays, const ListFormat& format)
      : text_(std::move(text)), arrays_(std::move(arrays)), format_(format) {}
  /// Requires that there is one more.
  Value next();

 private:
  SharedText text_;
  std::vector<Starts> arrays_;
  const ListFormat& format_;
  std::size_t next_ = 0;
};

}  // namespace adit::codec
