#include "gateway/channel.hpp"

#include "dispatch/said.hpp"

namespace adit::gateway {

Channel::Channel(loop::Loop& loop, const char* name, uplink::Endpoint endpoint,
                 std::optional<icd::BearerToken> token, std::chrono::milliseconds answer_within)
    : loop_(loop), name_(name), answer_within_(answer_within) {
  if (token) connection_.emplace(loop, std::move(endpoint), std::move(*token));
}

void Channel::send(icd::Uri uri, std::string_view content_type, icd::ChunkedBytes body,
                   std::function<void(uplink::Outcome)> done) {
  finished_bytes_ += connection_->sent_bytes();
  sent_at_ = loop_.now();
  connection_->send({.method = std::string(icd::method_of(uri)),
                     .target = std::string(icd::path_of(uri)),
                     .content_type = std::string(content_type),
                     .body = std::move(body),
                     .answer_within = answer_within_},
                    [this, done = std::move(done)](uplink::Outcome outcome) {
                      note(outcome);
                      done(std::move(outcome));
                    });
}

void Channel::note(const uplink::Outcome& outcome) {
  heard_ = loop_.now();
  if (const auto* answered = std::get_if<uplink::Answered>(&outcome)) {
    last_status_ = answered->status;
    if (last_status_ == 429) ++throttled_;
    answer_ms_ = std::chrono::duration<double, std::milli>(heard_ - sent_at_).count();
    trouble_ = answered->status < 400 ? "" : dispatch::said(answered->status, answered->body);
  } else {
    last_status_ = 0;
    trouble_ = gateway::sentence_of(outcome);
  }
}

std::string Channel::trouble() const {
  if (!connection_) return std::string("no ") + name_ + " token is set";
  if (!trouble_.empty()) return trouble_;
  return connected() ? "" : connection_->trouble();
}

uplink::Endpoint endpoint_of(const settings::CommandPost& command_post, const settings::Address& address,
                             std::uint64_t bytes_per_second) {
  return {.address = address.address,
          .port = address.port,
          .interface = command_post.interface,
          .bytes_per_second = bytes_per_second,
          .connect_within = command_post.timeouts.connect};
}

std::string address_text(const settings::Address& address) {
  return address.address + ":" + std::to_string(address.port);
}

std::string sentence_of(const uplink::Outcome& outcome) {
  if (const auto* never = std::get_if<uplink::NeverSent>(&outcome)) return never->why;
  if (const auto* doubt = std::get_if<uplink::InDoubt>(&outcome)) return doubt->why;
  const auto& answered = std::get<uplink::Answered>(outcome);
  return dispatch::said(answered.status, answered.body);
}

}  // namespace adit::gateway
