#pragma once

#include <string>
#include <string_view>

#include "codec/splitter.hpp"

namespace adit::codec {

/// JSON of which nothing is split off: kept as it comes, and read when it is whole.
class JsonAtOnce final : public Splitter {
 public:
  explicit JsonAtOnce(Most most) : most_(most) {}

  icd::Checked<void> feed(std::string_view bytes) override;
  icd::Checked<Value> finish() override;

 private:
  const Most most_;
  std::string text_;
};

}  // namespace adit::codec
