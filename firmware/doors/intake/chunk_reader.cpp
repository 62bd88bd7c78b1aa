#include "intake/chunk_reader.hpp"

#include <algorithm>
#include <charconv>

#include "icd/text.hpp"
#include "intake/field_text.hpp"

namespace adit::intake {

ChunkReader::State ChunkReader::feed(std::string_view bytes, std::string& data) {
  while (state_ == State::More && !bytes.empty()) {
    bytes.remove_prefix(in_ == In::Data ? take_data(bytes, data) : take_line(bytes));
  }
  return state_;
}

std::size_t ChunkReader::take_data(std::string_view bytes, std::string& data) {
  const auto size = static_cast<std::size_t>(std::min<std::uint64_t>(bytes.size(), left_));
  data += bytes.substr(0, size);
  left_ -= size;
  if (left_ == 0) in_ = In::AfterData;
  return size;
}

std::size_t ChunkReader::take_line(std::string_view bytes) {
  const auto end = std::min(bytes.find('\n'), bytes.size());
  line_ += bytes.substr(0, end);
  if (line_.size() > kMostLine) {
    refuse("chunked body: a line is longer than 4096 bytes");
  } else if (in_ == In::AfterData && !std::string_view("\r").starts_with(line_)) {
    refuse("chunked body: a chunk is longer than its size");
  } else if (end < bytes.size()) {
    whole_line();
    line_.clear();
  }
  return std::min(end + 1, bytes.size());
}

void ChunkReader::whole_line() {
  if (!line_.ends_with('\r')) {
    refuse("chunked body: each line must end in CRLF");
    return;
  }
  line_.pop_back();
  if (in_ == In::AfterData) {
    in_ = In::Size;
  } else if (in_ == In::Size) {
    size_line();
  } else {
    trailer_line();
  }
}

/// RFC 9112 7.1, 7.1.1: 1*HEXDIG, and extensions after a semicolon.
void ChunkReader::size_line() {
  const std::string_view line = line_;
  const std::string_view digits = line.substr(0, line.find_first_not_of("0123456789abcdefABCDEF"));
  const std::string_view rest = icd::trimmed(line.substr(digits.size()), kBlanks);
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), left_, 16);
  const bool is_extended = rest.starts_with(';') && has_no_controls(rest);
  if (digits.empty() || digits.size() > 16 || error != std::errc() ||
      left_ > static_cast<std::uint64_t>(INT64_MAX) || (digits.size() != line.size() && !is_extended)) {
    refuse("chunked body: expected the size of a chunk in hexadecimal digits");
  } else {
    in_ = left_ > 0 ? In::Data : In::Trailers;
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

}  // namespace adit::intake
