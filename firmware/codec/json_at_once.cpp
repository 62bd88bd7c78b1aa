#include "codec/json_at_once.hpp"

#include "codec/json_splitter.hpp"
#include "codec/quick_json.hpp"

namespace adit::codec {

icd::Checked<void> JsonAtOnce::feed(std::string_view bytes) {
  if (bytes.size() > most_.text - text_.size()) return std::unexpected(text_too_large(most_.text));
  text_ += bytes;
  return {};
}

/// What is wrong with it, a JsonSplitter says.
icd::Checked<Value> JsonAtOnce::finish() {
  if (auto root = quick_json(text_, most_.values)) return std::move(*root);
  BulkData none(0);
  JsonSplitter splitter(Split::Nothing, most_, none);
  if (auto fed = splitter.feed(text_); !fed) return std::unexpected(std::move(fed.error()));
  return splitter.finish();
}

}  // namespace adit::codec
