#pragma once

#include <memory>

#include "intake/answer.hpp"

namespace adit::intake {

/// Answers 404 to everything.
class NotFound final : public Handler {
 public:
  Credentials read_credentials(const RequestHead&) override { return Credentials::Nothing; }
  std::unique_ptr<BodySink> open(const RequestHead&, std::shared_ptr<Responder> responder,
                                 std::shared_ptr<FlowControl>) override {
    responder->answer(error_answer(icd::Status::NotFound, "there is nothing here"));
    return nullptr;
  }
};

}  // namespace adit::intake
