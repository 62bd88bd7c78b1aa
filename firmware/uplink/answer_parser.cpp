// The one place that includes Boost.Beast, whose headers take seconds to compile.
#include "uplink/answer_parser.hpp"

#include <charconv>
#include <optional>
#include <utility>

#include "uplink/http_date.hpp"

// GCC 12 sees boost::optional as uninitialised where the sanitizers keep it from inlining.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/string_body.hpp>
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic pop
#endif

namespace adit::uplink {
namespace {

namespace http = boost::beast::http;
using Parser = http::response_parser<http::string_body>;

constexpr std::uint32_t kLongestHead = 16 * 1024;
constexpr unsigned kFirstFinal = 200, kLast = 599, kSwitchingProtocols = 101;

/// Seconds, or nothing where it is absent or a date (RFC 9110 10.2.3).
std::optional<std::chrono::seconds> retry_after(std::string_view value) {
  std::int32_t seconds = 0;
  const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), seconds);
  if (error != std::errc() || end != value.data() + value.size() || seconds < 0) return std::nullopt;
  return std::chrono::seconds(seconds);
}

std::string to_string(boost::beast::string_view text) {
  return {text.data(), text.size()};
}

}  // namespace

struct AnswerParser::Impl {
  std::unique_ptr<Parser> parser;
  std::string unread;  // what the parser has not consumed
  std::size_t read = 0;
  std::string fault;

  Impl() { begin(); }

  void begin() {
    parser = std::make_unique<Parser>();
    parser->eager(true);
    parser->header_limit(kLongestHead);
    parser->body_limit(Connection::kLongestAnswer);
  }

  State malformed(std::string why) {
    fault = std::move(why);
    return State::Malformed;
  }

  State malformed(boost::beast::error_code error) {
    const bool too_long = error == http::error::body_limit || error == http::error::header_limit;
    return malformed(too_long ? "the answer is too long" : "the answer is no HTTP: " + error.message());
  }

  /// Whole, or Incomplete where a 1xx has made place for the answer proper.
  State head_and_body_done() {
    const unsigned status = parser->get().result_int();
    if (status >= kFirstFinal && status <= kLast) return State::Whole;
    // 101 would end HTTP on this connection; we never asked for that.
    if (status == kSwitchingProtocols || status < 100 || status > kLast)
      return malformed("the answer has status " + std::to_string(status));
    begin();
    return State::Incomplete;
  }

  State parse() {
    while (!unread.empty()) {
      boost::beast::error_code error;
      const std::size_t used = parser->put(boost::asio::buffer(unread), error);
      unread.erase(0, used);
      if (error == http::error::need_more) return State::Incomplete;
      if (error) return malformed(error);
      if (parser->is_done()) {
        if (const State state = head_and_body_done(); state != State::Incomplete) return state;
      } else if (used == 0) {
        return State::Incomplete;
      }
    }
    return State::Incomplete;
  }
};

AnswerParser::AnswerParser() : impl_(std::make_unique<Impl>()) {}
AnswerParser::AnswerParser(AnswerParser&&) noexcept = default;
AnswerParser& AnswerParser::operator=(AnswerParser&&) noexcept = default;
AnswerParser::~AnswerParser() = default;

AnswerParser::State AnswerParser::feed(std::string_view bytes) {
  impl_->read += bytes.size();
  // Interim answers and chunk extensions could go on for ever without ever reaching the body's limit.
  if (impl_->read > Connection::kLongestAnswer) return impl_->malformed("the answer is too long");
  impl_->unread.append(bytes);
  return impl_->parse();
}

AnswerParser::State AnswerParser::feed_end() {
  if (!has_begun()) return impl_->malformed("the peer closed the connection and did not answer");
  boost::beast::error_code error;
  // A parser that has seen nothing since an interim answer would take the end for a whole 200.
  if (impl_->parser->is_header_done()) impl_->parser->put_eof(error);
  if (error || !impl_->parser->is_done())
    return impl_->malformed("the peer closed the connection in the middle of its answer");
  return impl_->head_and_body_done();
}

Answered AnswerParser::take() {
  auto message = impl_->parser->release();
  Answered answered;
  answered.status = static_cast<int>(message.result_int());
  answered.content_type = to_string(message[http::field::content_type]);
  answered.retry_after = retry_after(to_string(message[http::field::retry_after]));
  answered.date = http_date(to_string(message[http::field::date]));
  answered.body = std::move(message.body());
  return answered;
}

bool AnswerParser::may_keep_alive() const {
  return impl_->parser->keep_alive() && impl_->unread.empty();
}
const std::string& AnswerParser::fault() const {
  return impl_->fault;
}
bool AnswerParser::has_begun() const {
  return impl_->read > 0;
}

}  // namespace adit::uplink
