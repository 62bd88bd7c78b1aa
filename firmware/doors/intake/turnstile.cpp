#include "intake/turnstile.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "icd/bearer_token.hpp"
#include "icd/uri.hpp"
#include "intake/answer.hpp"

namespace adit::intake {

TokenGuesses::Verdict TokenGuesses::right(const std::string& address, loop::Instant now) {
  Count& count = count_of(address, now);
  if (!count.has_been_right && !count.guesses.has_guess(now)) return {TokenCheck::NotChecked, true};
  count.has_been_right = true;
  return {TokenCheck::Right, false};
}

TokenGuesses::Verdict TokenGuesses::wrong(const std::string& address, std::string_view token,
                                          loop::Instant now) {
  Count& count = count_of(address, now);
  const std::string_view kept = token.substr(0, icd::BearerToken::kLongest + 1);  // longer: no token
  if (std::ranges::find(count.wrong, kept) == count.wrong.end()) {
    if (!count.guesses.has_guess(now)) return {TokenCheck::NotChecked, true};
    count.guesses.use(now);
    count.wrong[std::exchange(count.next, (count.next + 1) % count.wrong.size())] = kept;
  }
  const bool late = !count.answers.has_guess(now);
  if (!late) count.answers.use(now);
  return {TokenCheck::Wrong, late};
}

TokenGuesses::Count& TokenGuesses::count_of(const std::string& address, loop::Instant now) {
  if (!counts_.contains(address) && counts_.size() >= kMostAddresses) {
    counts_.erase(std::ranges::min_element(counts_, {}, [](const auto& each) {
      return std::pair(each.second.has_been_right, each.second.last);
    }));
  }
  Count& count = counts_[address];
  count.last = now;
  return count;
}

namespace {

using TokenCheck = TokenGuesses::TokenCheck;

/// Delays the answer. Owned by its DelayedSink, which lives as long as the request.
class DelayedResponder final : public PassingResponder {
 public:
  DelayedResponder(loop::Loop& loop, std::shared_ptr<Responder> responder, std::chrono::milliseconds late)
      : PassingResponder(std::move(responder)), loop_(loop), late_(late) {}

  void answer(Answer answer) override {
    if (answer_) return;
    answer_ = std::move(answer);
    timer_ = loop_.timer([this] { inner().answer(std::move(*answer_)); });
    timer_.call_at(loop_.now() + late_);
  }
  bool has_answer() const { return answer_.has_value(); }

 private:
  loop::Loop& loop_;
  const std::chrono::milliseconds late_;
  std::optional<Answer> answer_;
  loop::Source timer_;
};

/// Passes the body on to `sink` until there is an answer.
class DelayedSink final : public BodySink {
 public:
  DelayedSink(std::shared_ptr<DelayedResponder> responder, std::unique_ptr<BodySink> sink)
      : responder_(std::move(responder)), sink_(std::move(sink)) {}
  bool on_body(std::span<const std::uint8_t> piece) override {
    const bool more = sink_ && !responder_->has_answer() && sink_->on_body(piece);
    return more && !responder_->has_answer();
  }
  void on_end() override {
    if (sink_ && !responder_->has_answer()) sink_->on_end();
  }
  void on_gone() override {
    if (sink_ && !responder_->has_answer()) sink_->on_gone();
  }

 private:
  const std::shared_ptr<DelayedResponder> responder_;
  const std::unique_ptr<BodySink> sink_;
};

Answer unchecked_answer() {
  return error_answer(
      icd::Status::TooManyRequests,
      "too many wrong tokens from this address; this token was not checked; try again in a second");
}

}  // namespace

Credentials Turnstile::read_credentials(const RequestHead& head) {
  verdict_ = {};
  const std::string_view token = icd::token_in(head.header("Authorization"));
  const Credentials shown = handler_.read_credentials(head);
  if (shown == Credentials::Token) {
    verdict_ = guesses_.right(head.peer(), loop_.now());
  } else if (shown == Credentials::WrongToken) {
    verdict_ = guesses_.wrong(head.peer(), token, loop_.now());
  }
  if (verdict_.looked == TokenCheck::Right) return shown;
  if (!token.empty() || !icd::uri_of(head.path())) {
    refused_(CloseReason::WrongToken, head.peer());
  } else if (head.method() == "POST") {
    refused_(CloseReason::NoToken, head.peer());
  }
  return Credentials::WrongToken;
}

std::unique_ptr<BodySink> Turnstile::open(const RequestHead& head, std::shared_ptr<Responder> responder,
                                          std::shared_ptr<FlowControl> flow) {
  if (!verdict_.late) return handler_.open(head, std::move(responder), std::move(flow));
  auto late = std::make_shared<DelayedResponder>(loop_, std::move(responder), late_);
  if (verdict_.looked == TokenCheck::Wrong) {
    return std::make_unique<DelayedSink>(late, handler_.open(head, late, std::move(flow)));
  }
  late->answer(unchecked_answer());
  return std::make_unique<DelayedSink>(std::move(late), nullptr);
}

}  // namespace adit::intake
