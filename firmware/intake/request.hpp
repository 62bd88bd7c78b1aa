#pragma once

#include <memory>
#include <optional>
#include <span>

#include "intake/chunk_reader.hpp"
#include "intake/head.hpp"
#include "intake/head_checker.hpp"
#include "intake/reply_stream.hpp"
#include "intake/server.hpp"

namespace adit::intake {

class Client;

/// What is to become of the connection after one of libmicrohttpd's callbacks. Again: once the connection has
/// been resumed, the piece's last byte comes again.
enum class Next : std::uint8_t { GoOn, Again, Close };

/// The life of one request: driven by libmicrohttpd's callbacks on one side, and by whoever holds it as a
/// Responder or a Flow on the other. Outlives its connection for as long as they do.
class Request final : public Responder, public Flow, public std::enable_shared_from_this<Request> {
 public:
  Request(Client& client, std::string_view method);

  /// The connection's side.
  /// Its head is whole.
  void begin(std::string_view method, Target target, const Framing& framing);
  const RequestHead& head() const { return *head_; }
  void open(Handler& handler);
  /// Answers 400 without asking a handler, and ends the connection.
  void refuse_head(std::string_view sentence);
  /// Answers 503 without asking a handler, and ends the connection.
  void refuse_for_room(std::string_view sentence);
  /// A piece of it; of a chunked one, as it came.
  Next body(std::span<const std::uint8_t> piece);
  /// The body is whole; called again each time that the connection has been resumed.
  Next end();
  void late();
  /// Its head or body is not whole, and more of it is wanted.
  bool is_sending() const {
    return stage_ == Stage::Head || stage_ == Stage::Body || stage_ == Stage::Refusing;
  }
  /// libmicrohttpd has nothing of an answer to it yet.
  bool is_unanswered() const { return !answered() && (stage_ == Stage::Body || stage_ == Stage::Whole); }
  /// A callback of the handler's threw: answered 500, unless an answer was on its way, and the connection
  /// ends.
  Next failed();
  /// libmicrohttpd is done with it, in whatever way.
  void completed();

  /// The handler's side.
  void answer(Answer answer) override;
  std::shared_ptr<Stream> stream(std::string_view content_type) override;
  bool client_gone() const override;
  void resume() override;

 private:
  enum class Stage : std::uint8_t {
    Head,       // in Handler::open
    Body,       // more of it is to come
    Whole,      // the body has been taken; the handler answers now or later
    Answering,  // libmicrohttpd has the answer
    Refusing,   // answered past libmicrohttpd, in the middle of the body; the rest is thrown away
    Over,
  };

  bool answered() const { return answer_ || stream_; }
  Next take(std::span<const std::uint8_t> piece);
  /// Of a body that was answered before it was whole.
  Next throw_away(std::size_t bytes);
  Next take_chunks(std::span<const std::uint8_t> piece);
  /// The answer is there before the body is.
  void turn_away();
  void refuse(const Answer& answer);
  Next hand_over();
  void answer_came();

  Client* client_;  // null once over
  std::optional<Head> head_;
  std::unique_ptr<BodySink> sink_;
  std::optional<Answer> answer_;
  std::shared_ptr<ReplyStream> stream_;
  Stage stage_ = Stage::Head;
  bool is_head_;  // the method HEAD
  bool has_body_ = false;
  bool in_call_ = false;               // of the handler
  bool resumed_ = false;               // since the last piece
  std::optional<ChunkReader> chunks_;  // where the body comes in chunks
  std::optional<std::uint64_t> left_;  // of the body; absent where chunked
  std::size_t thrown_away_ = 0;
};

}  // namespace adit::intake
