#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "codec/value.hpp"

/// Well-formed documents whose arrays stay text, so that a large message is never a tree in memory.
namespace adit::codec {

using SharedText = std::shared_ptr<const std::string>;
/// Start of each array element in the text, then the start of a next one. Empty for an empty array.
using Starts = std::vector<std::uint32_t>;

/// The value at `begin` of a text, with its outermost arrays replaced by empty ones.
struct Cut {
  std::string rest;
  std::vector<Starts> arrays;  // in order
  std::size_t values = 0;      // number of values in `rest`
};
Cut cut_cbor(std::string_view text, std::size_t begin);

/// Functions that read elements of a format.
struct ListFormat {
  icd::Checked<Value> (*element)(const SharedText& text, std::size_t begin, std::size_t end);
  bool (*reals)(std::string_view element, std::span<const std::string_view> names, std::span<double> into);
  std::size_t gap;  // bytes between elements
};

/// A List of these elements. `format` must outlive it.
Value list_of(const SharedText& text, Starts starts, const ListFormat& format);

/// The replacements for the arrays of a Cut, in order.
class Lists {
 public:
  Lists(SharedText text, std::vector<Starts> arrays, const ListFormat& format)
      : text_(std::move(text)), arrays_(std::move(arrays)), format_(format) {}
  /// Requires another array.
  Value next();

 private:
  SharedText text_;
  std::vector<Starts> arrays_;
  const ListFormat& format_;
  std::size_t next_ = 0;
};

}  // namespace adit::codec
