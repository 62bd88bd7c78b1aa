#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "intake/head.hpp"
#include "intake/head_checker.hpp"
#include "intake/server.hpp"

struct MHD_Response;

namespace adit::intake {

class Client;

/// Parses a chunked body (RFC 9112 7.1) as it arrives. Skips extensions and trailers. Refuses each deviation
/// from the grammar, such as a bare LF or extra blanks.
class ChunkReader {
 public:
  enum class State : std::uint8_t { More, Whole, Refused };
  static constexpr std::size_t kMostLine = 4096;           // bytes of a size line with its extensions
  static constexpr std::size_t kMostTrailers = 16 * 1024;  // bytes

  /// Parses `bytes` and appends the bytes of the body to `data`. Ignores bytes after the end of the body.
  State feed(std::string_view bytes, std::string& data);
  State state() const { return state_; }
  /// For Refused: a sentence.
  std::string_view trouble() const { return trouble_; }

 private:
  enum class Section : std::uint8_t { Size, Data, AfterData, Trailers };

  std::size_t take_data(std::string_view bytes, std::string& data);
  std::size_t take_line(std::string_view bytes);
  void end_line();
  void size_line();
  void trailer_line();
  void refuse(std::string_view trouble);

  State state_ = State::More;
  Section in_ = Section::Size;
  std::uint64_t left_ = 0;  // bytes of the chunk that have not arrived
  std::string line_;        // the part of the line that has arrived
  std::size_t trailers_ = 0;
  std::string_view trouble_;
};

/// A stream's unsent bytes. The request holds it, and so does the handler until it ends the answer.
class ReplyStream final : public Stream {
 public:
  void attach(Client& client, std::string_view content_type) {
    client_ = &client;
    content_type_ = content_type;
  }
  bool send(std::string_view bytes) override;
  bool send_instead(std::string_view bytes) override;
  std::size_t waiting() const override { return waiting_ - read_; }
  /// Ends the answer after the queued bytes.
  void end();
  void detach() { client_ = nullptr; }

  /// The response for libmicrohttpd. Its connection is suspended while no bytes are queued.
  static MHD_Response* make_response(const std::shared_ptr<ReplyStream>& stream);

 private:
  ssize_t read(char* into, std::size_t most);

  Client* client_ = nullptr;  // null if the client is gone
  std::string content_type_;
  std::deque<std::string> pieces_;  // as they were given
  std::size_t waiting_ = 0;         // bytes of pieces_, with those of the first that were read
  std::size_t read_ = 0;            // bytes of the first piece
  bool ended_ = false;
};

enum class ConnectionAction : std::uint8_t { KeepOpen, Close };

/// One request, from its head to the end of its answer. libmicrohttpd's callbacks drive it on one side, or
/// Client if its body is chunked, and holders of its Responder or FlowControl on the other. It outlives its
/// connection while they hold it.
class Request final : public Responder, public FlowControl, public std::enable_shared_from_this<Request> {
 public:
  Request(Client& client, std::string_view method);

  /// The connection's side. The head is whole.
  void begin(std::string text, Target target, const Framing& framing);
  const RequestHead& head() const { return *head_; }
  void open(Handler& handler);
  /// Answers 400 without a handler and closes the connection.
  void refuse_head(std::string_view sentence);
  /// Answers 503 without a handler and closes the connection.
  void refuse_for_room(std::string_view sentence);
  /// A piece of the body; of a chunked body with its chunk headers.
  ConnectionAction body(std::span<const std::uint8_t> piece);
  /// True if a chunked body is whole, and end() was not called.
  bool has_unended_body() const;
  /// The body is whole. Called again each time the connection is resumed.
  ConnectionAction end();
  void on_late();
  /// True while more of the head or the body is to come.
  bool is_sending() const {
    return stage_ == Stage::Head || stage_ == Stage::Body || stage_ == Stage::Refusing;
  }
  /// An answer without `Connection: close` was given to libmicrohttpd.
  bool keeps_connection() const { return stage_ == Stage::Answering && !stream_ && !is_last_; }
  /// True if libmicrohttpd has no part of an answer yet.
  bool is_unanswered() const { return !is_answered() && (stage_ == Stage::Body || stage_ == Stage::Whole); }
  /// A callback of the handler threw. Answers 500, unless an answer is being sent, and closes the connection.
  ConnectionAction on_failed();
  /// libmicrohttpd has finished the request, in any way.
  void on_completed();

  /// The handler's side.
  void answer(Answer answer) override;
  std::shared_ptr<Stream> stream(std::string_view content_type) override;
  bool is_client_gone() const override;
  void resume() override;

 private:
  enum class Stage : std::uint8_t {
    Head,       // in Handler::open()
    Body,       // more of the body is to come
    Whole,      // the handler has the whole body and answers now or later
    Answering,  // libmicrohttpd has the answer
    Refusing,   // answered past libmicrohttpd before the body was whole; the rest is discarded
    Over,
  };

  bool is_answered() const { return answer_ || stream_; }
  void consume(std::span<const std::uint8_t> piece);
  /// Discards a piece of a body that was answered before it was whole.
  ConnectionAction discard_body(std::size_t bytes);
  void consume_chunks(std::span<const std::uint8_t> piece);
  void send_early_answer();
  void refuse(Answer answer);
  /// Lets pages read an answer of the ICD's URIs, and that there is no such URI. Not the box's files and API.
  void open_to_pages(Answer& answer) const;
  ConnectionAction hand_over();
  void on_answer();

  Client* client_;  // null once over
  std::optional<Head> head_;
  std::unique_ptr<BodySink> sink_;
  std::optional<Answer> answer_;
  std::shared_ptr<ReplyStream> stream_;
  Stage stage_ = Stage::Head;
  bool is_last_ = false;  // on its connection, as far as Adit decides it
  bool is_head_;          // the method is HEAD
  bool has_body_ = false;
  bool in_call_ = false;               // a call of the handler is running
  bool resumed_ = false;               // since the last piece
  std::optional<ChunkReader> chunks_;  // set if the body is chunked
  std::optional<std::uint64_t> left_;  // of the body; absent if chunked
  std::size_t thrown_away_ = 0;
};

}  // namespace adit::intake
