#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "icd/sentence.hpp"
#include "intake/server.hpp"
#include "page/answers.hpp"

namespace adit::page {

/// Gathers a body of a few KiB, and hands it over once it is whole.
class SmallBody final : public intake::Exchange {
 public:
  static constexpr std::size_t kMost = 4096;

  SmallBody(std::shared_ptr<intake::Responder> responder, std::function<void(std::string body)> done)
      : responder_(std::move(responder)), done_(std::move(done)) {}

  bool on_body(std::span<const std::uint8_t> piece) override {
    if (refused_) return true;
    if (body_.size() + piece.size() > kMost) {
      refused_ = true;
      responder_->answer(refusal(icd::Status::ContentTooLarge,
                                 icd::sentence("expected a body of at most ", kMost, " bytes")));
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
  std::function<void(std::string)> done_;
  std::string body_;
  bool refused_ = false;
};

}  // namespace adit::page
