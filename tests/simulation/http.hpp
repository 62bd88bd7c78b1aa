#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace adit::simulation {

constexpr const char* kJson = "Content-Type: application/json\r\n";

/// A request or an answer of HTTP/1.1: with a length, chunked, or interim.
struct HttpMessage {
  std::string first;                           // first line
  std::map<std::string, std::string> headers;  // by lower-case name
  std::string body;

  std::string header(const std::string& name) const;
  std::string path() const;  // of a request, without a slash at its end
  bool has_slash() const;    // at the end of its path
  int status() const;        // of an answer
};

/// Parses the messages of one direction of a connection.
class HttpStream {
 public:
  void feed(std::string_view bytes) { bytes_ += bytes; }
  /// The next complete message.
  std::optional<HttpMessage> next();
  /// Whether no byte of an incomplete message has arrived.
  bool is_between() const { return bytes_.empty() && !head_; }
  /// The head of the incomplete message, once complete.
  const std::optional<HttpMessage>& head() const { return head_; }
  std::size_t length() const { return length_; }      // of its body, or of its next chunk
  std::size_t read() const { return bytes_.size(); }  // of its body, if the head gives its length
  /// The part of the incomplete message's first line that has arrived.
  std::string_view begun() const { return bytes_; }

 private:
  bool take_body();
  bool take_chunks();

  std::string bytes_;
  std::optional<HttpMessage> head_;
  std::size_t length_ = 0;
};

/// A target without a slash at its end.
std::string without_slash(std::string target);
std::string http_request(std::string_view method, std::string_view path, std::string_view headers,
                         std::string_view body);
/// `status_line`: "200 OK".
std::string http_answer(std::string_view status_line, std::string_view headers, std::string_view body);

}  // namespace adit::simulation
