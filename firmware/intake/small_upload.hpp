#pragma once

#include "codec/body_decoder.hpp"
#include "icd/rules.hpp"
#include "intake/visit.hpp"

namespace adit::intake {

/// Takes a state, a markers update or a report: at most a megabyte, decoded on the loop as it arrives.
class SmallUpload final : public Exchange {
 public:
  SmallUpload(Visit visit, codec::BodyKind kind, const icd::Rules& rules)
      : visit_(std::move(visit)), rules_(rules), decoder_(kind, codec::Split::Nothing, {}) {
    visit_.sender.bytes = 0;
  }

  bool on_body(std::span<const std::uint8_t> piece) override;
  void on_end() override;

 private:
  void give_to_desk(const codec::Document& document);

  Visit visit_;
  icd::Rules rules_;
  codec::BodyDecoder decoder_;
};

}  // namespace adit::intake
