#pragma once

#include "codec/body_decoder.hpp"
#include "icd/rules.hpp"
#include "intake/upload.hpp"
#include "intake/upload_budget.hpp"
#include "intake/visit.hpp"

namespace adit::intake {

/// Receives a state or a report of at most a megabyte. The loop decodes it as it arrives.
class SmallUpload final : public Upload {
 public:
  SmallUpload(Visit visit, codec::BodyKind kind, const icd::Rules& rules,
              std::shared_ptr<UploadBudget> budget)
      : Upload(visit),
        visit_(std::move(visit)),
        share_(std::move(budget), visit_.sender.address),
        rules_(rules),
        decoder_(kind, codec::Split::Nothing, {.values = kSmallValues}) {
    visit_.sender.bytes = 0;
  }

  bool on_body(std::span<const std::uint8_t> piece) override;
  void on_end() override;
  void turn_away(const icd::Refusal& refusal) override {
    if (!whole_) visit_.refuse(refusal);
  }

 private:
  void give_to_desk(const codec::Document& document);
  void take_report(const codec::Document& document);

  Visit visit_;
  UploadShare share_;
  icd::Rules rules_;
  codec::BodyDecoder decoder_;
  bool whole_ = false;
};

}  // namespace adit::intake
