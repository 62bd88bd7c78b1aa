#include "intake/request.hpp"

#include <microhttpd.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "icd/text.hpp"
#include "icd/uri.hpp"
#include "intake/answer.hpp"
#include "intake/client.hpp"
#include "intake/head.hpp"
#include "loop/guard.hpp"

namespace adit::intake {

ChunkReader::State ChunkReader::feed(std::string_view bytes, std::string& data) {
  while (state_ == State::More && !bytes.empty()) {
    bytes.remove_prefix(in_ == Section::Data ? take_data(bytes, data) : take_line(bytes));
  }
  return state_;
}

std::size_t ChunkReader::take_data(std::string_view bytes, std::string& data) {
  const auto size = static_cast<std::size_t>(std::min<std::uint64_t>(bytes.size(), left_));
  data += bytes.substr(0, size);
  left_ -= size;
  if (left_ == 0) in_ = Section::AfterData;
  return size;
}

std::size_t ChunkReader::take_line(std::string_view bytes) {
  const auto end = std::min(bytes.find('\n'), bytes.size());
  line_ += bytes.substr(0, end);
  if (line_.size() > kMostLine) {
    refuse("chunked body: a line is longer than 4096 bytes");
  } else if (in_ == Section::AfterData && !std::string_view("\r").starts_with(line_)) {
    refuse("chunked body: a chunk is longer than its size");
  } else if (end < bytes.size()) {
    end_line();
    line_.clear();
  }
  return std::min(end + 1, bytes.size());
}

void ChunkReader::end_line() {
  if (!line_.ends_with('\r')) return refuse("chunked body: each line must end in CRLF");
  line_.pop_back();
  if (in_ == Section::AfterData) {
    in_ = Section::Size;
  } else if (in_ == Section::Size) {
    size_line();
  } else {
    trailer_line();
  }
}

/// RFC 9112 7.1, 7.1.1: 1*HEXDIG, and extensions after a semicolon.
void ChunkReader::size_line() {
  const std::string_view line = line_;
  const std::string_view digits = line.substr(0, line.find_first_not_of("0123456789abcdefABCDEF"));
  const std::string_view rest = icd::trim(line.substr(digits.size()), kBlanks);
  const auto size = icd::number_in<std::uint64_t>(digits, 16);
  const bool is_extended = rest.starts_with(';') && has_no_controls(rest);
  if (!size || digits.size() > 16 || *size > static_cast<std::uint64_t>(INT64_MAX) ||
      (digits.size() != line.size() && !is_extended)) {
    refuse("chunked body: expected the size of a chunk in hexadecimal digits");
  } else {
    left_ = *size;
    in_ = left_ > 0 ? Section::Data : Section::Trailers;
  }
}

/// RFC 9112 7.1.2
void ChunkReader::trailer_line() {
  trailers_ += line_.size();
  if (line_.empty()) {
    state_ = State::Whole;
  } else if (const auto field = parse_field_line(line_); !field) {
    refuse("chunked body: expected header fields as trailers");
  } else if (trailers_ > kMostTrailers) {
    refuse("chunked body: expected at most 16384 bytes of trailers");
  }
}

void ChunkReader::refuse(std::string_view trouble) {
  state_ = State::Refused;
  trouble_ = trouble;
}

namespace {

constexpr std::size_t kBlock = 16 * 1024;

}  // namespace

bool ReplyStream::send(std::string_view bytes) {
  if (client_ == nullptr || client_->has_hung_up()) return false;
  if (waiting() + bytes.size() > kLag) {
    client_->cut();
    detach();
    return false;
  }
  if (bytes.empty()) return true;
  waiting_ += bytes.size();
  pieces_.emplace_back(bytes);
  client_->resume();
  return true;
}

bool ReplyStream::send_instead(std::string_view bytes) {
  while (pieces_.size() > (read_ > 0 ? 1 : 0)) {
    waiting_ -= pieces_.back().size();
    pieces_.pop_back();
  }
  return send(bytes);
}

void ReplyStream::end() {
  ended_ = true;
  if (client_ != nullptr) client_->resume();
}

ssize_t ReplyStream::read(char* into, std::size_t most) {
  if (client_ == nullptr || client_->has_hung_up()) return MHD_CONTENT_READER_END_WITH_ERROR;
  if (pieces_.empty()) {
    if (ended_) return MHD_CONTENT_READER_END_OF_STREAM;
    client_->suspend();
    return 0;
  }
  const std::string& piece = pieces_.front();
  const std::size_t size = std::min(most, piece.size() - read_);
  std::memcpy(into, piece.data() + read_, size);
  read_ += size;
  if (read_ == piece.size()) {
    waiting_ -= std::exchange(read_, 0);
    pieces_.pop_front();
  }
  return static_cast<ssize_t>(size);
}

MHD_Response* ReplyStream::make_response(const std::shared_ptr<ReplyStream>& stream) {
  using Shared = std::shared_ptr<ReplyStream>;
  auto held = std::make_unique<Shared>(stream);
  MHD_Response* response = MHD_create_response_from_callback(
      MHD_SIZE_UNKNOWN, kBlock,
      [](void* cls, std::uint64_t, char* into, std::size_t most) {
        return (*static_cast<Shared*>(cls))->read(into, most);
      },
      held.get(), [](void* cls) { const std::unique_ptr<Shared> released(static_cast<Shared*>(cls)); });
  if (response == nullptr) return nullptr;
  held.release();  // NOLINT(bugprone-unused-return-value): the response owns it now
  if (is_field_value(stream->content_type_)) {
    MHD_add_response_header(response, MHD_HTTP_HEADER_CONTENT_TYPE, stream->content_type_.c_str());
  }
  MHD_add_response_header(response, MHD_HTTP_HEADER_CACHE_CONTROL, "no-store");
  MHD_add_response_header(response, "X-Accel-Buffering", "no");  // nginx would keep events back
  return response;
}

namespace {

/// The rest of a body that is answered early is read if it is at most kReadAway and arrives within
/// kReadAwayWithin, so that the connection can be kept. Otherwise the answer is sent at once, and later bytes
/// are discarded, because closing a socket with unread bytes resets it, and the client would lose the answer:
/// most libraries read it only after they have sent everything. From an authenticated client all of it is
/// discarded, at the least rate; from an unauthenticated one this much, within 5 s, so that a robot with an
/// old token learns why its map is rejected.
constexpr std::size_t kReadAway = 64 * 1024;
constexpr std::chrono::milliseconds kReadAwayWithin(1000);
constexpr std::size_t kLingerUnauthenticated = 8 << 20;

Answer failure() {
  return error_answer(icd::Status::InternalServerError,
                      "Adit could not finish this request and may have accepted it; send it again");
}

/// The handler's Responder. If the handler drops it without an answer, even by an exception, the request gets
/// a 500, so that its client does not wait for ever.
class AnswerGuard final : public PassingResponder {
 public:
  using PassingResponder::PassingResponder;
  AnswerGuard(const AnswerGuard&) = delete;
  AnswerGuard& operator=(const AnswerGuard&) = delete;
  ~AnswerGuard() override {
    loop::run_guarded("the answer to a dropped request", [this] { inner().answer(failure()); });
  }

  void answer(Answer answer) override { inner().answer(std::move(answer)); }
};

}  // namespace

Request::Request(Client& client, std::string_view method) : client_(&client), is_head_(method == "HEAD") {}

void Request::begin(std::string text, Target target, const Framing& framing) {
  left_ = framing.length;
  has_body_ = framing.has_body;
  if (!framing.length) chunks_.emplace();
  head_.emplace(std::move(text), std::move(target), client_->peer(), client_->local(), client_->is_secure(),
                framing.length);
}

void Request::open(Handler& handler) {
  in_call_ = true;
  sink_ = handler.open(*head_, std::make_shared<AnswerGuard>(shared_from_this()), shared_from_this());
  in_call_ = false;
  stage_ = Stage::Body;
  if (!sink_ && !is_answered()) answer_ = error_answer(icd::Status::InternalServerError, "no answer");
  if (!has_body_) return;
  if (is_answered()) {
    send_early_answer();
  } else {
    client_->deadline().expect_body();
    client_->gate().acknowledge_head();
    if (chunks_ && icd::equals_ignoring_case(head_->header("Expect"), "100-continue")) {
      client_->write_text("HTTP/1.1 100 Continue\r\n\r\n");
    }
  }
}

void Request::refuse_head(std::string_view sentence) {
  answer_ = error_answer(icd::Status::BadRequest, sentence);
  refuse(*answer_);
}

void Request::refuse_for_room(std::string_view sentence) {
  answer_ = error_answer(icd::Status::ServiceUnavailable, sentence);
  refuse(*answer_);
}

ConnectionAction Request::body(std::span<const std::uint8_t> piece) {
  if (stage_ == Stage::Refusing) {
    return discard_body(piece.size());
  }
  if (left_) *left_ -= std::min<std::uint64_t>(piece.size(), *left_);
  if (is_answered()) return ConnectionAction::KeepOpen;  // the rest is read and ignored
  if (chunks_) {
    consume_chunks(piece);
  } else {
    consume(piece);
  }
  return ConnectionAction::KeepOpen;
}

bool Request::has_unended_body() const {
  return chunks_ && chunks_->state() == ChunkReader::State::Whole && stage_ == Stage::Body && !is_answered();
}

ConnectionAction Request::discard_body(std::size_t bytes) {
  if (is_answered()) sink_.reset();  // frees its data, because discarding may take long
  thrown_away_ += bytes;
  client_->deadline().on_body(bytes);
  const bool is_enough = !client_->deadline().is_authenticated() && thrown_away_ > kLingerUnauthenticated;
  return is_enough ? ConnectionAction::Close : ConnectionAction::KeepOpen;
}

void Request::consume_chunks(std::span<const std::uint8_t> piece) {
  std::string data;
  const auto state = chunks_->feed({reinterpret_cast<const char*>(piece.data()), piece.size()}, data);
  if (state == ChunkReader::State::Refused) {
    refuse(error_answer(icd::Status::BadRequest, chunks_->trouble()));
  } else if (!data.empty()) {
    consume({reinterpret_cast<const std::uint8_t*>(data.data()), data.size()});
  }
}

void Request::consume(std::span<const std::uint8_t> piece) {
  resumed_ = false;
  in_call_ = true;
  const bool more = sink_->on_body(piece);
  in_call_ = false;
  if (is_answered()) {
    send_early_answer();
  } else if (more || resumed_) {
    client_->deadline().on_body(piece.size());
  } else {
    client_->deadline().expect_nothing();
    client_->suspend();
  }
}

ConnectionAction Request::end() {
  if (stage_ == Stage::Refusing) return ConnectionAction::Close;
  if (stage_ == Stage::Body) {
    stage_ = Stage::Whole;
    client_->deadline().expect_nothing();
    if (!is_answered()) {
      in_call_ = true;
      sink_->on_end();
      in_call_ = false;
    }
  }
  if (is_answered()) return hand_over();
  if (client_->has_hung_up()) return ConnectionAction::Close;
  client_->suspend();
  return ConnectionAction::KeepOpen;
}

void Request::send_early_answer() {
  if (stream_) {
    client_->cut();  // a stream in the middle of a body is not supported
  } else if (left_ && *left_ <= kReadAway) {
    client_->deadline().expect_bytes(kReadAwayWithin);
    client_->resume();
  } else {
    refuse(*answer_);
  }
}

void Request::open_to_pages(Answer& answer) const {
  if (!head_) return;
  const bool is_nothing = answer.status == icd::Status::NotFound && !head_->path().starts_with(kApiPaths);
  if (is_nothing || icd::uri_of(head_->path())) allow_any_origin(answer);
}

void Request::refuse(Answer answer) {
  open_to_pages(answer);
  client_->write_last(last_answer_text(answer, !is_head_));
  stage_ = Stage::Refusing;
  if (has_body_) {
    client_->deadline().expect_body();
  } else {
    client_->deadline().expect_last_reading();
  }
  client_->resume();
}

ConnectionAction Request::hand_over() {
  if (chunks_) {  // libmicrohttpd does not know of the request
    send_early_answer();
    return ConnectionAction::KeepOpen;
  }
  if (!stream_) open_to_pages(*answer_);
  MHD_Response* response = stream_ ? ReplyStream::make_response(stream_) : make_response(*answer_);
  if (response == nullptr) return ConnectionAction::Close;
  const unsigned status = stream_ ? MHD_HTTP_OK : static_cast<unsigned>(answer_->status);
  const Gate::Traffic traffic = client_->gate().traffic();
  is_last_ = client_->gate().is_passed_by(traffic.received);
  if (is_last_) MHD_add_response_header(response, MHD_HTTP_HEADER_CONNECTION, "close");
  const MHD_Result queued = MHD_queue_response(client_->connection(), status, response);
  MHD_destroy_response(response);
  if (queued != MHD_YES) return ConnectionAction::Close;
  stage_ = Stage::Answering;
  if (stream_) {
    client_->expect_stream();
  } else {
    client_->deadline().expect_steady_reading(traffic.taken);
  }
  return ConnectionAction::KeepOpen;
}

void Request::on_late() {
  if (stage_ == Stage::Body && answer_) return refuse(*answer_);
  if (stage_ != Stage::Refusing) client_->engine().on_closed(CloseReason::Slow, client_->peer());
  if (stage_ == Stage::Body) {
    refuse(error_answer(icd::Status::RequestTimeout, "the body of the request took too long"));
  }
  client_->cut();
}

ConnectionAction Request::on_failed() {
  in_call_ = false;
  const bool whole = stage_ == Stage::Whole;
  if (stream_ || stage_ == Stage::Answering || stage_ == Stage::Refusing || stage_ == Stage::Over)
    return ConnectionAction::Close;
  if (!answer_) answer_ = failure();
  refuse(*answer_);
  return whole ? ConnectionAction::Close : ConnectionAction::KeepOpen;
}

void Request::on_completed() {
  if (stage_ == Stage::Over) return;
  stage_ = Stage::Over;
  client_ = nullptr;
  if (stream_) stream_->detach();
  const std::unique_ptr<BodySink> sink = std::move(sink_);
  if (sink && !is_answered()) sink->on_gone();
  head_.reset();
}

void Request::answer(Answer answer) {
  if (is_answered() || is_client_gone()) return;
  answer_ = std::move(answer);
  on_answer();
}

std::shared_ptr<Stream> Request::stream(std::string_view content_type) {
  auto stream = std::make_shared<ReplyStream>();
  if (!is_answered() && !is_client_gone()) {
    stream->attach(*client_, content_type);
    stream_ = stream;
    on_answer();
  }
  ReplyStream* const sent = stream.get();
  return {sent, [held = std::move(stream)](Stream*) { held->end(); }};  // the handler has dropped it
}

void Request::on_answer() {
  if (in_call_) return;  // the running call handles the answer
  if (stage_ == Stage::Body || chunks_) {
    send_early_answer();
  } else {
    client_->resume();
  }
}

bool Request::is_client_gone() const {
  return stage_ == Stage::Over || client_->has_hung_up() || (stage_ == Stage::Refusing && !is_answered());
}

void Request::resume() {
  resumed_ = true;
  if (stage_ != Stage::Body || !client_->is_suspended()) return;
  client_->deadline().expect_body();
  client_->resume();
}

}  // namespace adit::intake
