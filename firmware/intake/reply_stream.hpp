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

/// What a Stream has been given and the client has not yet been sent.
class ReplyStream {
 public:
  void attach(Client& client, std::string_view content_type) {
    client_ = &client;
    content_type_ = content_type;
  }
  bool append(std::string_view bytes);
  bool replace(std::string_view bytes);
  std::size_t waiting() const { return waiting_ - read_; }
  /// Nothing follows what has been appended.
  void end();
  /// The client is gone.
  void detach() { client_ = nullptr; }

  /// The answer for libmicrohttpd, which suspends its connection whenever there is nothing to send.
  static MHD_Response* make_response(const std::shared_ptr<ReplyStream>& stream);

 private:
  ssize_t read(char* into, std::size_t most);

  Client* client_ = nullptr;  // null where it is gone
  std::string content_type_;
  std::deque<std::string> pieces_;  // as they were given
  std::size_t waiting_ = 0;         // bytes of them
  std::size_t read_ = 0;            // of the first
  bool ended_ = false;
};

/// The handler's end of it. Dropping it ends the answer.
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
