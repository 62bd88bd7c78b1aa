#pragma once

#include <algorithm>
#include <string>
#include <string_view>

#include "codec/body_decoder.hpp"

namespace adit::codec {

/// Knows when the value that comes next is the one at "msg.data": the same walk for JSON and for CBOR.
class DataPath {
 public:
  explicit DataPath(Split split) : wanted_(split == Split::MapData) {}

  /// Into an object or an array.
  void open() {
    ++depth_;
    in_msg_ = in_msg_ || (depth_ == 2 && msg_named_);
    data_named_ = false;
  }
  void close() {
    --depth_;
    in_msg_ = in_msg_ && depth_ >= 2;
    data_named_ = false;
  }
  /// The key of the member that comes; "" for one that is no text.
  void key(std::string_view name) {
    if (depth_ == 1) msg_named_ = name == "msg";
    if (depth_ == 1) type_named_ = name == "type";
    if (depth_ == 2) data_named_ = in_msg_ && name == "data";
  }

  bool at_data() const { return wanted_ && depth_ == 2 && data_named_; }

  /// A piece of a text that is no key.
  void text(std::string_view piece) {
    if (depth_ == 1 && type_named_)
      type_ += piece.substr(0, kGrid.size() + 1 - std::min(type_.size(), kGrid.size() + 1));
  }
  /// Whether the body has said that it is a grid. True also of one that says so and something else, which is
  /// refused at its end: a member is given twice there.
  bool is_grid() const { return type_ == kGrid; }

  /// A longer key is neither "msg" nor "data": no more of it need be kept.
  static constexpr std::size_t kLongestKey = 5;

 private:
  static constexpr std::string_view kGrid = "OccupancyGrid";  // ICD 6.3.1

  bool wanted_;
  int depth_ = 0;
  bool msg_named_ = false;
  bool in_msg_ = false;
  bool data_named_ = false;
  bool type_named_ = false;
  std::string type_;  // its first characters
};

}  // namespace adit::codec
