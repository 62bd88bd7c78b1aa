#include "codec/json_at_once.hpp"

#include <utility>

#include "codec/quick_json.hpp"

namespace adit::codec {

icd::Checked<void> JsonAtOnce::feed(std::string_view bytes) {
  const bool is_first = !root_ && !splitter_;
  if (is_first && bytes.size() <= most_.text) root_ = quick_json(bytes, most_.values);
  if (is_first && root_) {
    text_ = bytes;
    return {};
  }
  root_.reset();
  if (auto fed = splitter().feed(std::exchange(text_, {})); !fed) return fed;
  return splitter().feed(bytes);
}

icd::Checked<Value> JsonAtOnce::finish() {
  return root_ ? std::move(*root_) : splitter().finish();
}

JsonSplitter& JsonAtOnce::splitter() {
  return splitter_ ? *splitter_ : splitter_.emplace(Split::Nothing, most_, none_);
}

}  // namespace adit::codec
