#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace adit::simulation {

constexpr const char* kJson = "Content-Type: application/json\r\n";

/// A request or an answer of HTTP/1.1 that says its length, comes in chunks, or is an interim one.
struct HttpMessage {
  std::string first;                           // its first line
  std::map<std::string, std::string> headers;  // by names in lower case
  std::string body;

  std::string header(const std::string& name) const;
  std::string path() const;  // of a request
  int status() const;        // of an answer
};

/// The messages of one direction of a connection, out of its bytes.
class HttpStream {
 public:
  void feed(std::string_view bytes) { bytes_ += bytes; }
  /// The next whole one.
  std::optional<HttpMessage> next();
  /// No byte of a message that is not whole has come.
  bool is_between() const { return bytes_.empty() && !head_; }
  /// Of the one that is not whole: its head, once that has come, and how long its body is to be.
  const std::optional<HttpMessage>& head() const { return head_; }
  std::size_t length() const { return length_; }  // or of its next chunk
  /// What has come of the first line of the one that is not whole.
  std::string_view begun() const { return bytes_; }

 private:
  bool take_body();
  bool take_chunks();

  std::string bytes_;
  std::optional<HttpMessage> head_;
  std::size_t length_ = 0;
};

std::string http_request(std::string_view method, std::string_view path, std::string_view headers,
                         std::string_view body);
/// `status_line`: "200 OK".
std::string http_answer(std::string_view status_line, std::string_view headers, std::string_view body);

}  // namespace adit::simulation
