#pragma once

#include <sys/types.h>

#include <cstddef>
#include <deque>
#include <memory>
#include <string>

#include "intake/server.hpp"

struct MHD_Response;

namespace adit::intake {

class Client;

/// The bytes of a Stream that the client has not been sent.
class ReplyStream {
 public:
  void attach(Client& client, std::string_view content_type) {
    client_ = &client;
    content_type_ = content_type;
  }
  bool append(std::string_view bytes);
  bool replace(std::string_view bytes);
  std::size_t waiting() const { return waiting_ - read_; }
  /// Ends the answer after the queued bytes.
  void end();
  /// The client is gone.
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

/// The handler's end of a stream. Its destructor ends the answer.
class ReplyStreamEnd final : public Stream {
 public:
  explicit ReplyStreamEnd(std::shared_ptr<ReplyStream> stream) : stream_(std::move(stream)) {}
  ReplyStreamEnd(const ReplyStreamEnd&) = delete;
  ReplyStreamEnd& operator=(const ReplyStreamEnd&) = delete;
  ~ReplyStreamEnd() override { stream_->end(); }
  bool send(std::string_view bytes) override { return stream_->append(bytes); }
  bool send_instead(std::string_view bytes) override { return stream_->replace(bytes); }
  std::size_t waiting() const override { return stream_->waiting(); }

 private:
  std::shared_ptr<ReplyStream> stream_;
};

}  // namespace adit::intake
