// Only this file includes Boost.Beast, because its headers take seconds to compile. Disables its assertions,
// which a release does not have. One of them is wrong: for "0\r\n", the last chunk of an empty body, and one
// more byte, it fails although the bytes were parsed correctly (basic_parser.ipp, parse_chunk_header()).
#define BOOST_DISABLE_ASSERTS

// GCC 12 warns of an uninitialised boost::optional if the sanitizers prevent inlining.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic pop
#endif
#include "uplink/answer_parser.hpp"

#include <algorithm>
#include <boost/beast/core/buffers_range.hpp>
#include <boost/beast/http/error.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/parser.hpp>
#include <ctime>
#include <utility>

#include "codec/content_decoder.hpp"
#include "icd/letter_case.hpp"
#include "icd/require.hpp"
#include "icd/text.hpp"
#include "loop/guard.hpp"

namespace adit::uplink {
namespace {

namespace http = boost::beast::http;

/// The body of an answer, kept as it arrives. Beast's string_body reserves the announced length before it
/// checks the limit.
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
std::string decoded(std::string body, std::string_view coding, std::size_t longest) {
  const bool is_gzip = icd::same_but_for_case(coding, "gzip") || icd::same_but_for_case(coding, "x-gzip");
  if (!is_gzip && !icd::same_but_for_case(coding, "deflate")) return body;
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

  State malformed(std::string why) {
    fault = std::move(why);
    return State::Malformed;
  }

  State malformed(boost::beast::error_code error) {
    if (error == http::error::body_limit || error == http::error::header_limit) return too_long(error);
    return malformed("the answer is not HTTP: " + error.message());
  }

  /// The status is known if the head was parsed. body_limit is reported after the head.
  State too_long(boost::beast::error_code error) {
    const bool has_status = error == http::error::body_limit || parser->is_header_done();
    if (has_status) too_long_status = static_cast<int>(parser->get().result_int());
    return malformed("the answer is too long");
  }

  /// Whole, or Incomplete after a 1xx, which the final answer follows.
  State head_and_body_done() {
    const unsigned status = parser->get().result_int();
    if (status >= kFirstFinal && status <= kLast) return State::Whole;
    // 101 would end HTTP on this connection. Adit never asks for that.
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

AnswerParser::AnswerParser(std::size_t longest_body) : impl_(std::make_unique<Impl>(longest_body)) {}
AnswerParser::~AnswerParser() = default;

AnswerParser::State AnswerParser::feed(std::string_view bytes) {
  icd::require(impl_->fault.empty() && !impl_->parser->is_done());
  impl_->read += bytes.size();
  // Interim answers and chunk extensions could go on for ever and never reach the body's limit.
  if (impl_->read > kMostBytes(impl_->longest_body)) return impl_->too_long({});
  State state = State::Malformed;
  const bool well = loop::guarded("reading an answer", [&] {
    impl_->unread.append(bytes);
    state = impl_->parse();
  });
  return well ? state : impl_->malformed("the answer could not be read");
}

AnswerParser::State AnswerParser::feed_end() {
  if (!has_begun()) return impl_->malformed("the peer closed the connection and did not answer");
  boost::beast::error_code error;
  // After an interim answer the new parser has read no bytes, and put_eof() would make it a whole 200.
  if (impl_->parser->is_header_done()) impl_->parser->put_eof(error);
  if (error || !impl_->parser->is_done())
    return impl_->malformed("the peer closed the connection in the middle of its answer");
  return impl_->head_and_body_done();
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

Answered AnswerParser::take() {
  auto message = impl_->parser->release();
  Answered answered;
  answered.status = static_cast<int>(message.result_int());
  answered.content_type = to_string(message[http::field::content_type]);
  answered.date = http_date(to_string(message[http::field::date]));
  answered.retry_after = retry_after(to_string(message[http::field::retry_after]), answered.date);
  answered.body = decoded(std::move(message.body().text), to_string(message[http::field::content_encoding]),
                          impl_->longest_body);
  return answered;
}

bool AnswerParser::may_keep_alive() const {
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

}  // namespace adit::uplink
