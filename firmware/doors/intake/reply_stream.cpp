#include "intake/reply_stream.hpp"

#include <microhttpd.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "intake/answer.hpp"
#include "intake/client.hpp"

namespace adit::intake {
namespace {

constexpr std::size_t kBlock = 16 * 1024;

}  // namespace

bool ReplyStream::append(std::string_view bytes) {
  if (client_ == nullptr || client_->hung_up()) return false;
  if (waiting() + bytes.size() > Stream::kLag) {
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

bool ReplyStream::replace(std::string_view bytes) {
  while (pieces_.size() > (read_ > 0 ? 1 : 0)) {
    waiting_ -= pieces_.back().size();
    pieces_.pop_back();
  }
  return append(bytes);
}

void ReplyStream::end() {
  ended_ = true;
  if (client_ != nullptr) client_->resume();
}

ssize_t ReplyStream::read(char* into, std::size_t most) {
  if (client_ == nullptr || client_->hung_up()) return MHD_CONTENT_READER_END_WITH_ERROR;
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
  return response;
}

}  // namespace adit::intake
