// Only this file includes Boost.Beast, because its headers take seconds to compile. Disables its assertions,
// which a release does not have. One of them is wrong: for "0\r\n", the last chunk of an empty body, and one
// more byte, it fails although the bytes were parsed correctly (basic_parser.ipp, parse_chunk_header()).
#define BOOST_DISABLE_ASSERTS

#include "uplink/exchange.hpp"

#include <algorithm>
#include <array>
#include <boost/beast/core/buffers_range.hpp>
#include <boost/beast/http/error.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/parser.hpp>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <utility>

#include "codec/content_decoder.hpp"
#include "icd/require.hpp"
#include "icd/status.hpp"
#include "icd/text.hpp"
#include "loop/guard.hpp"

namespace adit::uplink {
namespace {

namespace http = boost::beast::http;

/// Keeps a body as it arrives. Beast's string_body reserves the announced length before it checks the limit.
struct BoundedBody {
  struct value_type {
    std::string text;
    std::size_t longest = 0;
  };
  class reader {
   public:
    template <bool isRequest, class Fields>
    reader(http::header<isRequest, Fields>&, value_type& body) : body_(body) {}

    void init(const boost::optional<std::uint64_t>& length, boost::beast::error_code& error) {
      error = {};
      if (length && *length > body_.longest) error = http::error::body_limit;
    }
    template <class Buffers>
    std::size_t put(const Buffers& buffers, boost::beast::error_code& error) {
      error = {};
      std::size_t taken = 0;
      for (const boost::asio::const_buffer piece : boost::beast::buffers_range_ref(buffers)) {
        if (piece.size() > body_.longest - body_.text.size()) {
          error = http::error::body_limit;
          return taken;
        }
        body_.text.append(static_cast<const char*>(piece.data()), piece.size());
        taken += piece.size();
      }
      return taken;
    }
    void finish(boost::beast::error_code& error) { error = {}; }

   private:
    value_type& body_;
  };
};
using Parser = http::response_parser<BoundedBody>;

/// The limit for the head, all interim answers before it, the body and its chunk headers.
constexpr std::size_t kMostBytes(std::size_t longest_body) {
  return 2 * AnswerParser::kLongestHead + 2 * longest_body;
}
constexpr unsigned kFirstFinal = 200, kLast = 599, kSwitchingProtocols = 101;

/// Seconds from now (RFC 9110 10.2.3), at most kLongestPause. A date is compared with the answer's own
/// `date`, because the two clocks may differ. nullopt if the field is absent or neither.
std::optional<std::chrono::seconds> retry_after(const std::string& value,
                                                std::optional<std::chrono::sys_seconds> date) {
  constexpr std::chrono::seconds kLongestPause = std::chrono::days(1);
  constexpr std::size_t kFewDigits = 9;
  const bool is_number = !value.empty() && value.find_first_not_of("0123456789") == std::string::npos;
  if (is_number && value.size() > kFewDigits) return kLongestPause;
  if (is_number) return std::min(kLongestPause, std::chrono::seconds(*icd::number_in<std::int32_t>(value)));
  const auto until = http_date(value);
  if (!until || !date) return std::nullopt;
  return std::clamp<std::chrono::seconds>(*until - *date, {}, kLongestPause);
}

/// `body` without its Content-Encoding, though Adit asks for none. As it came if the coding is unknown, the
/// bytes are invalid, or they would exceed `longest` bytes.
std::string decode_body(std::string body, std::string_view coding, std::size_t longest) {
  const bool is_gzip =
      icd::equals_ignoring_case(coding, "gzip") || icd::equals_ignoring_case(coding, "x-gzip");
  if (!is_gzip && !icd::equals_ignoring_case(coding, "deflate")) return body;
  std::string text;
  codec::ContentDecoder decoder(is_gzip ? codec::ContentCoding::Gzip : codec::ContentCoding::Deflate, longest,
                                [&text](std::string_view piece) -> icd::Checked<void> {
                                  text += piece;
                                  return {};
                                });
  const bool is_valid = decoder.feed(body).has_value() && decoder.finish().has_value();
  return is_valid ? text : body;
}

std::string to_string(boost::beast::string_view text) {
  return {text.data(), text.size()};
}

}  // namespace

std::optional<std::chrono::sys_seconds> http_date(const std::string& text) {
  using namespace std::chrono;
  constexpr std::string_view kForm = "Sun, 06 Nov 1994 08:49:37 GMT";
  if (text.size() != kForm.size()) return std::nullopt;
  std::tm parts{};
  const char* const end = strptime(text.c_str() + 3, ", %d %b %Y %H:%M:%S GMT", &parts);
  if (end != text.c_str() + text.size()) return std::nullopt;
  const year_month_day date{year(parts.tm_year + 1900), month(static_cast<unsigned>(parts.tm_mon + 1)),
                            day(static_cast<unsigned>(parts.tm_mday))};
  if (!date.ok()) return std::nullopt;
  return sys_days(date) + hours(parts.tm_hour) + minutes(parts.tm_min) + seconds(parts.tm_sec);
}

struct AnswerParser::Impl {
  std::unique_ptr<Parser> parser;
  const std::size_t longest_body;
  std::string unread;  // not yet consumed by the parser
  std::size_t read = 0;
  std::string fault;
  int too_long_status = 0;

  explicit Impl(std::size_t longest) : longest_body(longest) { begin(); }

  void begin() {
    parser = std::make_unique<Parser>();
    parser->eager(true);
    parser->header_limit(kLongestHead);
    parser->body_limit(longest_body);
    parser->get().body().longest = longest_body;
  }

  State on_malformed(std::string why) {
    fault = std::move(why);
    return State::Malformed;
  }

  State on_malformed(boost::beast::error_code error) {
    if (error == http::error::body_limit || error == http::error::header_limit) return on_too_long(error);
    return on_malformed("the answer is not HTTP: " + error.message());
  }

  /// The status is known if the head was parsed. body_limit is reported after the head.
  State on_too_long(boost::beast::error_code error) {
    const bool has_status = error == http::error::body_limit || parser->is_header_done();
    if (has_status) too_long_status = static_cast<int>(parser->get().result_int());
    return on_malformed("the answer is too long");
  }

  /// Whole, or Incomplete after a 1xx, which the final answer follows.
  State finish_message() {
    const unsigned status = parser->get().result_int();
    if (status >= kFirstFinal && status <= kLast) return State::Whole;
    // 101 would end HTTP on this connection. Adit never asks for that.
    if (status == kSwitchingProtocols || status < 100 || status > kLast)
      return on_malformed("the answer has status " + std::to_string(status));
    begin();
    return State::Incomplete;
  }

  State parse() {
    while (!unread.empty()) {
      boost::beast::error_code error;
      const std::size_t used = parser->put(boost::asio::buffer(unread), error);
      unread.erase(0, used);
      if (error == http::error::need_more) return State::Incomplete;
      if (error) return on_malformed(error);
      if (parser->is_done()) {
        if (const State state = finish_message(); state != State::Incomplete) return state;
      } else if (used == 0) {
        return State::Incomplete;
      }
    }
    return State::Incomplete;
  }
};

AnswerParser::AnswerParser(std::size_t longest_body) : impl_(std::make_unique<Impl>(longest_body)) {}
AnswerParser::~AnswerParser() = default;

AnswerParser::State AnswerParser::feed(std::string_view bytes) {
  icd::require(impl_->fault.empty() && !impl_->parser->is_done());
  impl_->read += bytes.size();
  // Interim answers and chunk extensions could go on for ever and never reach the body's limit.
  if (impl_->read > kMostBytes(impl_->longest_body)) return impl_->on_too_long({});
  State state = State::Malformed;
  const bool well = loop::run_guarded("reading an answer", [&] {
    impl_->unread.append(bytes);
    state = impl_->parse();
  });
  return well ? state : impl_->on_malformed("the answer could not be read");
}

AnswerParser::State AnswerParser::feed_end() {
  if (!has_begun()) return impl_->on_malformed("the peer closed the connection and did not answer");
  boost::beast::error_code error;
  // After an interim answer the new parser has read no bytes, and put_eof() would make it a whole 200.
  if (impl_->parser->is_header_done()) impl_->parser->put_eof(error);
  if (error || !impl_->parser->is_done())
    return impl_->on_malformed("the peer closed the connection in the middle of its answer");
  return impl_->finish_message();
}

int AnswerParser::status() const {
  return impl_->parser->is_header_done() ? static_cast<int>(impl_->parser->get().result_int()) : 0;
}

std::string AnswerParser::take_part() {
  impl_->read = impl_->unread.size() + 1;  // not 0, so that has_begun() stays true
  impl_->parser->body_limit(impl_->longest_body);
  return std::exchange(impl_->parser->get().body().text, {});
}

std::string AnswerParser::location() const {
  return to_string(impl_->parser->get()[http::field::location]);
}

Answered AnswerParser::take_answer() {
  auto message = impl_->parser->release();
  Answered answered;
  answered.status = static_cast<int>(message.result_int());
  answered.content_type = to_string(message[http::field::content_type]);
  answered.date = http_date(to_string(message[http::field::date]));
  answered.retry_after = retry_after(to_string(message[http::field::retry_after]), answered.date);
  answered.body = decode_body(std::move(message.body().text),
                              to_string(message[http::field::content_encoding]), impl_->longest_body);
  return answered;
}

bool AnswerParser::can_keep_alive() const {
  return impl_->parser->keep_alive() && impl_->unread.empty();
}
int AnswerParser::too_long_status() const {
  return impl_->too_long_status;
}

const std::string& AnswerParser::fault() const {
  return impl_->fault;
}
bool AnswerParser::has_begun() const {
  return impl_->read > 0;
}

namespace {

/// Chunks written at once: about a megabyte, so that the loop stays quick.
constexpr std::size_t kChunksAtOnce = 17;
/// Calls of listen() within answer_within.
constexpr int kListenings = 8;

/// RFC 9112 2.1. Sends no Expect, which the measured mapping server never answers, and no chunks, because the
/// length is known. The measured servers want a canonical `Bearer` and a content type without parameters.
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
std::span<iovec> first_bytes(std::span<iovec> pieces, std::size_t bytes) {
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
  if (icd::equals_ignoring_case(location.substr(0, kScheme.size()), kScheme)) {
    location.remove_prefix(kScheme.size());
    std::string there(location.substr(0, location.find('/')));
    location.remove_prefix(there.size());
    const bool has_port = there.find(':', there.rfind(']') + 1) != std::string::npos;
    if (!has_port) there += ":80";
    if (!icd::equals_ignoring_case(there, authority)) return {};
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
  if (!is_limited() || now < request_.last_byte_not_before) return false;
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
  const std::span<iovec> may_go = first_bytes(std::span(pieces).first(count), may_go_ - sent_);
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

Exchange::Answer Exchange::on_lost(const std::string& why) {
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
    if (error != 0) return on_lost(std::strerror(error));
    // The write consumed the socket's error, so this may be a reset and ends no answer without a length.
    if (*got == 0 && write_broken_) return on_lost("the peer closed the connection during the request");
    if (is_early_) return on_lost(*got == 0 ? "it closed the connection" : "it sent bytes after the answer");
    const auto state = *got == 0 ? parser_.feed_end() : parser_.feed({bytes.data(), *got});
    if (state == AnswerParser::State::Malformed) return on_lost(parser_.fault());
    if (state == AnswerParser::State::Incomplete) continue;
    is_early_ = icd::is_success(status()) && !has_arrived(fd);
    if (!is_early_) return Answer::Whole;
  }
}

Answered Exchange::take_answer() {
  const std::string location = parser_.location();
  Answered answered = parser_.take_answer();
  answered.began = first_left_;
  answered.wants_slash = redirects_to_slash(answered.status, location, authority_, request_.target);
  return answered;
}

SendTimes Exchange::sent_times(const Transmission& seen, loop::Instant now) const {
  if (seen.sent_twice != sent_twice_) return {.first = now, .last = now};
  if (sent_ < total_) return {.first = first_left_, .last = now};
  return {.first = first_left_, .last = std::max(first_left_, now - seen.since_last_byte)};
}

void Exchange::listen(int fd, loop::Instant now) {
  const std::size_t acknowledged = sent_ - std::min(sent_, unacknowledged_bytes(fd));
  const bool nothing_to_hear = is_limited() && acknowledged == may_go_;
  if (acknowledged <= acknowledged_ && !nothing_to_hear && !request_.goes_ahead) return;
  acknowledged_ = acknowledged;
  heard_ = now;
}

loop::Instant Exchange::next_listening(loop::Instant now) const {
  const auto pause = is_early_ ? kLook : request_.answer_within / kListenings;
  const auto next = std::min<loop::Instant>(now + pause, silent_at());
  return is_limited() ? std::min(next, request_.last_byte_not_before) : next;
}

std::string Exchange::sentence(const std::string& what) const {
  return request_.method + " " + request_.target + " to " + authority_ + ": " + what + " (" +
         std::to_string(sent_) + " of " + std::to_string(total_) + " bytes sent)";
}

}  // namespace adit::uplink
