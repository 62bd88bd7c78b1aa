#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "codec/list.hpp"

/// Documents as a splitter keeps them, well-formed, JSON without white space, whose arrays stay text: a large
/// message is nowhere in memory as a tree.
namespace adit::codec {

using SharedText = std::shared_ptr<const std::string>;
/// Where each element of an array begins in its text, and then where the next would; none: it is empty.
using Starts = std::vector<std::uint32_t>;

/// The value from `begin` to `end` of a text without its outermost arrays, for which empty ones stand.
struct Cut {
  std::string rest;
  std::vector<Starts> arrays;  // as they come
  std::size_t values = 0;      // in `rest`
};
Cut cut_json(std::string_view text, std::size_t begin, std::size_t end);
Cut cut_cbor(std::string_view text, std::size_t begin);

/// What stands for the arrays of a Cut, one after the other.
class Lists {
 public:
  using Read = icd::Checked<Value> (*)(const SharedText& text, std::size_t begin, std::size_t end);

  /// `read` reads an element; between two of them are `gap` bytes.
  Lists(SharedText text, std::vector<Starts> arrays, Read read, std::size_t gap)
      : text_(std::move(text)), arrays_(std::move(arrays)), read_(read), gap_(gap) {}
  /// Requires that there is one more.
  Value next();

 private:
  SharedText text_;
  std::vector<Starts> arrays_;
  Read read_;
  std::size_t gap_;
  std::size_t next_ = 0;
};

}  // namespace adit::codec
