#include "uplink/exchange.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include "icd/success.hpp"

namespace adit::uplink {
namespace {

bool same_in_any_case(std::string_view one, std::string_view other) {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
  return std::ranges::equal(one, other, {}, lower, lower);
}

/// Chunks written at once: about a megabyte, so that the loop stays quick.
constexpr std::size_t kChunksAtOnce = 17;
/// Calls of listen() within answer_within.
constexpr int kListenings = 8;

/// RFC 9112 2.1. Sends no Expect, because the measured mapping server never answers it. Sends no chunks,
/// because the length is known. The measured servers want a canonical `Bearer` and a content type without
/// parameters.
icd::ChunkedBytes head_of(const std::string& authority, const icd::BearerToken& token,
                          const Request& request) {
  std::string head = request.method + " " + request.target + " HTTP/1.1\r\n";
  head += "Host: " + authority + "\r\n";
  head += "Authorization: Bearer " + token.reveal() + "\r\n";
  head += "User-Agent: adit/" ADIT_VERSION "\r\n";
  head += "Accept: application/json\r\n";
  head += "Accept-Encoding: identity\r\n";
  if (!request.content_type.empty()) head += "Content-Type: " + request.content_type + "\r\n";
  if (request.method != "GET") head += "Content-Length: " + std::to_string(request.body.size()) + "\r\n";
  head += "\r\n";
  return icd::ChunkedBytes({reinterpret_cast<const std::uint8_t*>(head.data()), head.size()});
}

/// The first `bytes` bytes of the pieces, or all pieces.
std::span<iovec> first_of(std::span<iovec> pieces, std::size_t bytes) {
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    pieces[i].iov_len = std::min(pieces[i].iov_len, bytes);
    bytes -= pieces[i].iov_len;
    if (bytes == 0) return pieces.first(i + 1);
  }
  return pieces;
}

}  // namespace

std::optional<bool> redirects_to_slash(int status, std::string_view location, std::string_view authority,
                                       std::string_view target) {
  constexpr std::string_view kScheme = "http://";
  const bool redirects = status == 301 || status == 302 || status == 307 || status == 308;
  if (!redirects) return {};
  if (same_in_any_case(location.substr(0, kScheme.size()), kScheme)) {
    location.remove_prefix(kScheme.size());
    std::string there(location.substr(0, location.find('/')));
    location.remove_prefix(there.size());
    const bool has_port = there.find(':', there.rfind(']') + 1) != std::string::npos;
    if (!has_port) there += ":80";
    if (!same_in_any_case(there, authority)) return {};
  }
  const bool has_slash = target.ends_with('/');
  const std::string_view longer = has_slash ? target : location, shorter = has_slash ? location : target;
  const bool is_other_form =
      longer.size() == shorter.size() + 1 && longer.starts_with(shorter) && longer.ends_with('/');
  if (!is_other_form || shorter.empty() || shorter.ends_with('/')) return {};
  return !has_slash;
}

Exchange::Exchange(const Endpoint& endpoint, const icd::BearerToken& token, Request request)
    : authority_(authority_of(endpoint)),
      request_(std::move(request)),
      chunks_(head_of(authority_, token, request_)),
      bytes_per_second_(endpoint.bytes_per_second),
      total_(chunks_.size() + request_.body.size()),
      may_go_(request_.last_byte_not_before == loop::Instant{}
                  ? total_
                  : total_ - std::min(request_.body.size(), Request::kHeldBack)),
      parser_(request_.longest_answer) {
  chunks_.append(std::exchange(request_.body, {}));
}

void Exchange::begin(loop::Instant now, std::uint64_t sent_twice) {
  heard_ = now;
  sent_twice_ = sent_twice;
  release(now);
}

bool Exchange::release(loop::Instant now) {
  if (!holds_back() || now < request_.last_byte_not_before) return false;
  may_go_ = total_;
  return true;
}

int Exchange::write(int fd) {
  std::array<iovec, kChunksAtOnce> pieces{};
  std::size_t count = 0;
  for (const auto& chunk : chunks_.chunks().first(std::min(kChunksAtOnce, chunks_.chunks().size()))) {
    const auto unsent = chunk->subspan(count == 0 ? within_chunk_ : 0);
    pieces[count++] = {const_cast<std::uint8_t*>(unsent.data()), unsent.size()};
  }
  const std::span<iovec> may_go = first_of(std::span(pieces).first(count), may_go_ - sent_);
  const auto taken =
      bytes_per_second_ > 0 ? write_evenly(fd, may_go, bytes_per_second_) : uplink::write(fd, may_go);
  if (taken) {
    advance(*taken);
    return 0;
  }
  const int error = taken.error();
  if (error == EAGAIN || error == EWOULDBLOCK || error == EINTR) return 0;
  write_broken_ = true;
  return error;
}

void Exchange::advance(std::size_t bytes) {
  sent_ += bytes;
  within_chunk_ += bytes;
  while (!chunks_.empty() && within_chunk_ >= chunks_.chunks().front()->size())
    within_chunk_ -= chunks_.pop_front()->size();
}

bool Exchange::has_arrived(int fd) const {
  return sent_ == total_ && unacknowledged_bytes(fd) == 0;
}

Exchange::Answer Exchange::lost(const std::string& why) {
  fault_ = sentence(is_early_ ? "the peer answered " + std::to_string(status()) +
                                    " before the whole request had arrived; then: " + why
                              : why);
  return Answer::Lost;
}

Exchange::Answer Exchange::read(int fd) {
  std::array<char, 16384> bytes;  // NOLINT(cppcoreguidelines-pro-type-member-init): read() fills it
  while (true) {
    if (is_early_ && has_arrived(fd)) return Answer::Whole;
    const auto got = uplink::read(fd, bytes);
    const int error = got ? 0 : got.error();
    if (error == EINTR) continue;
    if (error == EAGAIN || error == EWOULDBLOCK) return Answer::Waiting;
    if (error != 0) return lost(std::strerror(error));
    // The failed write has consumed the socket's error, so this end may be a reset and does not prove the end
    // of an answer without a length.
    if (*got == 0 && write_broken_) return lost("the peer closed the connection during the request");
    if (is_early_) return lost(*got == 0 ? "it closed the connection" : "it sent bytes after the answer");
    const auto state = *got == 0 ? parser_.feed_end() : parser_.feed({bytes.data(), *got});
    if (state == AnswerParser::State::Malformed) return lost(parser_.fault());
    if (state == AnswerParser::State::Incomplete) continue;
    is_early_ = icd::is_success(status()) && !has_arrived(fd);
    if (!is_early_) return Answer::Whole;
  }
}

Answered Exchange::take_answer() {
  const std::string location = parser_.location();
  Answered answered = parser_.take();
  answered.began = first_left_;
  answered.wants_slash = redirects_to_slash(answered.status, location, authority_, request_.target);
  return answered;
}

Sent Exchange::left(const Transmission& seen, loop::Instant now) const {
  if (seen.sent_twice != sent_twice_) return {.first = now, .last = now};
  if (sent_ < total_) return {.first = first_left_, .last = now};
  return {.first = first_left_, .last = std::max(first_left_, now - seen.since_last_byte)};
}

void Exchange::listen(int fd, loop::Instant now) {
  const std::size_t acknowledged = sent_ - std::min(sent_, unacknowledged_bytes(fd));
  const bool nothing_to_hear = holds_back() && acknowledged == may_go_;
  if (acknowledged <= acknowledged_ && !nothing_to_hear && !request_.goes_ahead) return;
  acknowledged_ = acknowledged;
  heard_ = now;
}

loop::Instant Exchange::next_listening(loop::Instant now) const {
  const auto pause = is_early_ ? kLook : request_.answer_within / kListenings;
  const auto next = std::min<loop::Instant>(now + pause, silent_at());
  return holds_back() ? std::min(next, request_.last_byte_not_before) : next;
}

std::string Exchange::sentence(const std::string& what) const {
  return request_.method + " " + request_.target + " to " + authority_ + ": " + what + " (" +
         std::to_string(sent_) + " of " + std::to_string(total_) + " bytes sent)";
}

}  // namespace adit::uplink
