#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "api/answers.hpp"
#include "icd/sentence.hpp"
#include "intake/server.hpp"

namespace adit::api {

/// Collects a body of at most `most` bytes and passes it to `done` when complete.
class SmallBody final : public intake::BodySink {
 public:
  SmallBody(std::shared_ptr<intake::Responder> responder, std::size_t most,
            std::function<void(std::string body)> done)
      : responder_(std::move(responder)), most_(most), done_(std::move(done)) {}

  static intake::Answer too_long(std::size_t most, std::string_view what = "body") {
    return refusal(icd::Status::ContentTooLarge,
                   icd::sentence("expected a ", what, " of at most ", most, " bytes"));
  }

  bool on_body(std::span<const std::uint8_t> piece) override {
    if (refused_) return true;
    if (body_.size() + piece.size() > most_) {
      refused_ = true;
      responder_->answer(too_long(most_));
    } else {
      body_.append(reinterpret_cast<const char*>(piece.data()), piece.size());
    }
    return true;
  }
  void on_end() override {
    if (!refused_) done_(std::move(body_));
  }

 private:
  std::shared_ptr<intake::Responder> responder_;
  std::size_t most_;
  std::function<void(std::string)> done_;
  std::string body_;
  bool refused_ = false;
};

}  // namespace adit::api
