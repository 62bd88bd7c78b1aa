#include "simulation/http.hpp"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <utility>

namespace adit::simulation {

std::string HttpMessage::header(const std::string& name) const {
  const auto found = headers.find(name);
  return found == headers.end() ? "" : found->second;
}

namespace {

std::string target_of(const std::string& first) {
  const std::size_t from = first.find(' ') + 1;
  return first.substr(from, first.find(' ', from) - from);
}

}  // namespace

std::string without_slash(std::string target) {
  if (target.size() > 1 && target.ends_with('/')) target.pop_back();
  return target;
}

std::string HttpMessage::path() const {
  return without_slash(target_of(first));
}

bool HttpMessage::has_slash() const {
  return target_of(first).ends_with('/');
}

int HttpMessage::status() const {
  return std::atoi(first.c_str() + std::min<std::size_t>(first.size(), first.find(' ') + 1));
}

std::optional<HttpMessage> HttpStream::next() {
  if (!head_) {
    const std::size_t end = bytes_.find("\r\n\r\n");
    if (end == std::string::npos) return std::nullopt;
    HttpMessage head;
    std::size_t at = bytes_.find("\r\n");
    head.first = bytes_.substr(0, at);
    while (at < end) {
      at += 2;
      const std::size_t next = bytes_.find("\r\n", at);
      const std::string line = bytes_.substr(at, next - at);
      const std::size_t colon = std::min(line.find(": "), line.size());
      std::string name = line.substr(0, colon);
      std::ranges::transform(name, name.begin(), [](unsigned char letter) { return std::tolower(letter); });
      if (colon < line.size()) head.headers[name] = line.substr(colon + 2);
      at = next;
    }
    bytes_.erase(0, end + 4);
    length_ = std::strtoull(head.header("content-length").c_str(), nullptr, 10);
    head_ = std::move(head);
  }
  const bool is_whole = head_->header("transfer-encoding") == "chunked" ? take_chunks() : take_body();
  return is_whole ? std::exchange(head_, std::nullopt) : std::nullopt;
}

/// Returns whether the body is complete.
bool HttpStream::take_body() {
  if (bytes_.size() < length_) return false;
  head_->body = bytes_.substr(0, length_);
  bytes_.erase(0, length_);
  return true;
}

bool HttpStream::take_chunks() {
  while (true) {
    const std::size_t end = bytes_.find("\r\n");
    if (end == std::string::npos) return false;
    length_ = std::strtoull(bytes_.c_str(), nullptr, 16);
    if (bytes_.size() - end - 2 < length_ || bytes_.size() - end - 2 - length_ < 2) return false;
    head_->body += bytes_.substr(end + 2, length_);
    bytes_.erase(0, end + 2 + length_ + 2);
    if (length_ == 0) return true;
  }
}

std::string http_request(std::string_view method, std::string_view path, std::string_view headers,
                         std::string_view body) {
  std::string text = std::string(method) + " " + std::string(path) + " HTTP/1.1\r\n" + std::string(headers);
  if (method != "GET") text += "Content-Length: " + std::to_string(body.size()) + "\r\n";
  return text + "\r\n" + std::string(body);
}

std::string http_answer(std::string_view status_line, std::string_view headers, std::string_view body) {
  return "HTTP/1.1 " + std::string(status_line) + "\r\n" + std::string(headers) +
         "Content-Length: " + std::to_string(body.size()) + "\r\n\r\n" + std::string(body);
}

}  // namespace adit::simulation
