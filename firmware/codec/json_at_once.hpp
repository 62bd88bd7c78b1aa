#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "codec/json_splitter.hpp"
#include "codec/splitter.hpp"

namespace adit::codec {

/// JSON of which nothing is split off. Nearly every such body comes in one piece, which is read at once; any
/// other, and what is wrong, is a JsonSplitter's from the first piece on, so that it is refused as soon as it
/// is wrong.
class JsonAtOnce final : public Splitter {
 public:
  explicit JsonAtOnce(Most most) : most_(most) {}

  icd::Checked<void> feed(std::string_view bytes) override;
  icd::Checked<Value> finish() override;

 private:
  JsonSplitter& splitter();

  const Most most_;
  std::optional<Value> root_;  // the document, if that was all
  std::string text_;           // of it
  BulkData none_{0};
  std::optional<JsonSplitter> splitter_;
};

}  // namespace adit::codec
