#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>

#include "codec/body_decoder.hpp"

namespace adit::codec {

/// Tracks whether the next value is the one at "msg.data", for JSON and CBOR.
class DataPath {
 public:
  explicit DataPath(Split split) : wanted_(split == Split::MapData) {}

  /// Enters an object or an array.
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
  /// Open objects and arrays.
  std::size_t depth() const { return depth_; }
  /// The key of the next member. It is "" if it is not a text.
  void begin_key() { key_.clear(); }
  void key_text(std::string_view piece) {
    if (key_.size() < kLongestKey) key_ += piece.substr(0, kLongestKey);
  }
  void end_key() {
    const std::string_view name = key_;
    if (depth_ == 1) msg_named_ = name == "msg";
    if (depth_ == 1) type_named_ = name == "type";
    if (depth_ == 2) data_named_ = in_msg_ && name == "data";
  }

  bool is_at_data() const { return wanted_ && depth_ == 2 && data_named_; }

  void text(std::string_view piece) {
    if (depth_ == 1 && type_named_)
      type_ += piece.substr(0, kGrid.size() + 1 - std::min(type_.size(), kGrid.size() + 1));
  }
  /// Whether the body has declared a grid, perhaps among other types; its end refuses a repeated member.
  bool is_grid() const { return type_ == kGrid; }

 private:
  /// Characters of a key to keep: longer keys cannot match.
  static constexpr std::size_t kLongestKey = 5;
  static constexpr std::string_view kGrid = "OccupancyGrid";  // ICD 6.3.1

  bool wanted_;
  std::size_t depth_ = 0;
  bool msg_named_ = false;
  bool in_msg_ = false;
  bool data_named_ = false;
  bool type_named_ = false;
  std::string key_;   // its first characters
  std::string type_;  // its first characters
};

}  // namespace adit::codec
