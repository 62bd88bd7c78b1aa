#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "icd/bearer_token.hpp"
#include "intake/answer.hpp"
#include "intake/server.hpp"

namespace adit::intake {

/// Acts by path:
///   /echo     answers with method, path, query `q`, peer and body
///   /refuse   401 before the body
///   /midway   422 at the first piece of the body
///   /later    keeps the responder for the test
///   /eager    as /later, from the head on
///   /held     accepts one piece of the body each time that the test resumes
///   /stream   keeps a stream
///   /nothing  neither answers nor takes the body
class ScriptedHandler final : public Handler {
 public:
  std::vector<std::shared_ptr<Responder>> responders;
  std::vector<std::shared_ptr<FlowControl>> flows;
  std::vector<std::shared_ptr<Stream>> streams;
  std::atomic<std::size_t> body_bytes = 0;
  std::atomic<int> ends = 0, gone = 0, exchanges = 0;
  bool asks_token = false;  // accepts tokens that do not begin with "wrong"

  Credentials read_credentials(const RequestHead& head) override {
    if (!asks_token) return Credentials::Enough;
    const std::string_view token = icd::token_in(head.header("Authorization"));
    return token.empty()                ? Credentials::Nothing
           : token.starts_with("wrong") ? Credentials::WrongToken
                                        : Credentials::Token;
  }

  std::unique_ptr<BodySink> open(const RequestHead& head, std::shared_ptr<Responder> responder,
                                 std::shared_ptr<FlowControl> flow) override {
    if (head.path() == "/refuse") {
      responder->answer(error_answer(icd::Status::Unauthorized, "no"));
      return nullptr;
    }
    if (head.path() == "/nothing") return nullptr;
    if (head.path() == "/eager") responders.push_back(responder);
    return std::make_unique<Scripted>(*this, head, std::move(responder), std::move(flow));
  }

 private:
  class Scripted final : public BodySink {
   public:
    Scripted(ScriptedHandler& script, const RequestHead& head, std::shared_ptr<Responder> responder,
             std::shared_ptr<FlowControl> flow)
        : script_(script),
          head_(head),
          responder_(std::move(responder)),
          flow_(std::move(flow)),
          path_(head.path()) {
      ++script_.exchanges;
    }
    ~Scripted() override { --script_.exchanges; }

    bool on_body(std::span<const std::uint8_t> piece) override {
      body_.append(reinterpret_cast<const char*>(piece.data()), piece.size());
      script_.body_bytes += piece.size();
      if (path_ == "/midway") responder_->answer(error_answer(icd::Status::UnprocessableEntity, "midway"));
      if (path_ != "/held") return true;
      script_.flows.push_back(flow_);
      return false;
    }

    void on_end() override {
      ++script_.ends;
      if (path_ == "/later") {
        script_.responders.push_back(responder_);
      } else if (path_ == "/stream") {
        script_.streams.push_back(responder_->stream("text/event-stream"));
      } else if (path_ != "/eager") {
        std::string text(head_.method());
        text.append(" ").append(head_.path()).append(" ").append(head_.query("q")).append(" ");
        text.append(head_.peer()).append(" ").append(body_);
        responder_->answer({.content_type = "text/plain", .body = text, .headers = {{"X-Echo", "yes"}}});
      }
    }

    void on_gone() override { ++script_.gone; }

   private:
    ScriptedHandler& script_;
    const RequestHead& head_;
    std::shared_ptr<Responder> responder_;
    std::shared_ptr<FlowControl> flow_;
    std::string path_, body_;
  };
};

}  // namespace adit::intake
