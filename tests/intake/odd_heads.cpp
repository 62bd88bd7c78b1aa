#include "intake/odd_heads.hpp"

#include "intake/head_checker.hpp"

namespace adit::intake {
namespace {

using namespace std::string_literals;

std::string request_line(std::string_view line) {
  return std::string(line) + "\r\nHost: adit\r\n\r\n";
}

std::string post_with(const std::string& fields) {
  return "POST /echo HTTP/1.1\r\nHost: adit\r\n" + fields + "\r\n\r\n";
}

std::string get_with(const std::string& fields) {
  return "GET /echo HTTP/1.1\r\n" + fields + "\r\n";
}

std::string repeated(const std::string& text, std::size_t times) {
  std::string all;
  for (std::size_t i = 0; i < times; ++i) all += text;
  return all;
}

}  // namespace

const std::vector<OddHead>& odd_heads() {
  static const std::vector<OddHead> kRows = {
      {"9112 2.2", "bare LF", "GET /echo HTTP/1.1\nHost: adit\n\n", 400, "CRLF"},
      {"9112 2.2", "bare LF behind a field", get_with("Host: adit\nX: 1\r\n"), 400, "CRLF"},
      {"9112 2.2", "bare LF as the last line", "GET /echo HTTP/1.1\r\nHost: adit\r\n\n", 400, "CRLF"},
      {"9112 2.2", "bare LF before all", "\nGET /echo HTTP/1.1\r\nHost: adit\r\n\r\n", 400, "CRLF"},
      {"9112 2.2", "bare CR in a value", post_with("X: a\rContent-Length: 5"), 400, "control"},
      {"9112 2.2", "bare CR in the target", request_line("GET /echo\r HTTP/1.1"), 400, "request target"},
      {"9112 2.2", "CR twice", "GET /echo HTTP/1.1\r\r\nHost: adit\r\n\r\n", 400, "request line"},
      {"9112 2.2", "a blank before the first field", get_with(" \r\nHost: adit\r\n"), 400, "folded"},
      {"9112 3", "two blanks", request_line("GET  /echo HTTP/1.1"), 400, "request line"},
      {"9112 3", "two blanks before the version", request_line("GET /echo  HTTP/1.1"), 400, "request line"},
      {"9112 3", "a blank behind the version", request_line("GET /echo HTTP/1.1 "), 400, "request line"},
      {"9112 3", "a blank before the method", request_line(" GET /echo HTTP/1.1"), 400, "request line"},
      {"9112 3", "tabs", request_line("GET\t/echo\tHTTP/1.1"), 400, "request line"},
      {"9112 3", "no version", request_line("GET /echo"), 400, "request line"},
      {"9112 3", "no target", request_line("GET HTTP/1.1"), 400, "request line"},
      {"9112 3", "a blank in the target", request_line("GET /echo more HTTP/1.1"), 400, "request line"},
      {"9112 3.1", "no token as the method", request_line("G(T /echo HTTP/1.1"), 400, "request line"},
      {"9112 2.3", "another case", request_line("GET /echo http/1.1"), 400, "request line"},
      {"9112 2.3", "two digits", request_line("GET /echo HTTP/1.10"), 400, "request line"},
      {"9112 2.3", "another protocol", request_line("GET /echo ICY/1.1"), 400, "request line"},
      {"9110 15.6.6", "an older version", request_line("GET /echo HTTP/0.9"), 505, "HTTP/0.9"},
      {"9110 15.6.6", "a newer version", request_line("PRI * HTTP/2.0"), 505, "HTTP/2.0"},
      {"9112 3.2", "no path", request_line("GET echo HTTP/1.1"), 400, "request target"},
      {"9112 3.2.3", "a place to connect to", request_line("CONNECT elsewhere:80 HTTP/1.1"), 400,
       "request target"},
      {"9112 3.2.4", "an asterisk", request_line("GET * HTTP/1.1"), 400, "request target"},
      {"9112 3.2.2", "elsewhere", request_line("GET http://elsewhere/echo HTTP/1.1"), 400, "Host"},
      {"9112 3.2.2", "another port", request_line("GET http://adit:81/echo HTTP/1.1"), 400, "Host"},
      {"9112 3.2.2", "another scheme", request_line("GET https://adit/echo HTTP/1.1"), 400, "request target"},
      {"9112 3.2.2", "elsewhere, no Host", "GET http://adit/echo HTTP/1.0\r\n\r\n", 400, "Host"},
      {"9110 4.2.4", "a user", request_line("GET http://me@adit/echo HTTP/1.1"), 400, "Host"},
      {"3986 2", "NUL in the target", request_line("GET /ec\0ho HTTP/1.1"s), 400, "request target"},
      {"3986 2", "a control character", request_line("GET /ec\x01ho HTTP/1.1"), 400, "request target"},
      {"3986 2", "DEL in the target", request_line("GET /ec\x7fho HTTP/1.1"), 400, "request target"},
      {"3986 2", "a tab in the target", request_line("GET /ec\tho HTTP/1.1"), 400, "request target"},
      {"9112 3.2", "no Host", get_with("X: 1\r\n"), 400, "Host: missing"},
      {"9112 3.2", "two Hosts", get_with("Host: adit\r\nHost: elsewhere\r\n"), 400, "Host: given twice"},
      {"9112 3.2", "the same twice", get_with("Host: adit\r\nhost: adit\r\n"), 400, "Host: given twice"},
      {"9112 3.2", "two Hosts of HTTP/1.0", "GET /echo HTTP/1.0\r\nHost: a\r\nHost: b\r\n\r\n", 400, "twice"},
      {"9110 5.3", "two content types",
       post_with("Content-Type: application/json\r\nContent-Type: application/cbor"), 400,
       "Content-Type: given twice"},
      {"9110 5.3", "and another letter case", post_with("content-type: a/b\r\nContent-Type: a/B"), 400,
       "Content-Type: given twice"},
      {"9110 5.3", "and none", post_with("Content-Type: a/b\r\nContent-Type:"), 400,
       "Content-Type: given twice"},
      {"9110 5.3", "and the first once more",
       post_with("Content-Type: a/b\r\nContent-Type: a/b\r\nContent-Type: a/c"), 400,
       "Content-Type: given twice"},
      {"9110 5.3", "two tokens", post_with("Authorization: Bearer a\r\nX: 1\r\nauthorization: Bearer b"), 400,
       "Authorization: given twice"},
      {"9110 5.3", "two origins", post_with("Origin: null\r\nOrigin: http://adit"), 400,
       "Origin: given twice"},
      {"9110 8.4", "two content codings", post_with("Content-Encoding: gzip\r\nContent-Encoding: deflate"),
       400, "Content-Encoding: given twice"},
      {"9110 8.4", "a content coding twice", post_with("Content-Encoding: gzip\r\nContent-Encoding: gzip"),
       400, "Content-Encoding: given twice"},
      {"9110 7.2", "Host with a path", get_with("Host: adit/echo\r\n"), 400, "Host"},
      {"9110 7.2", "Host with a user", get_with("Host: me@adit\r\n"), 400, "Host"},
      {"9110 7.2", "two names in Host", get_with("Host: adit elsewhere\r\n"), 400, "Host"},
      {"9110 7.2", "no port", get_with("Host: adit:http\r\n"), 400, "Host"},
      {"9110 7.2", "an open bracket", get_with("Host: [::1\r\n"), 400, "Host"},
      {"9110 7.2", "more behind a bracket", get_with("Host: [::1]adit\r\n"), 400, "Host"},
      {"9112 5.1", "a blank before the colon", post_with("Content-Length : 5"), 400, "colon"},
      {"9112 5.1", "a tab before the colon", post_with("Content-Length\t: 5"), 400, "colon"},
      {"9112 5.1", "a blank before the colon of a coding", post_with("Transfer-Encoding : chunked"), 400,
       "colon"},
      {"9110 5.1", "no name", post_with(": 5"), 400, "name"},
      {"9112 5", "no colon", post_with("Content-Length 5"), 400, "colon"},
      {"9110 5.1", "a blank in a name", post_with("Content Length: 5"), 400, "name"},
      {"9110 5.1", "NUL in a name", post_with("Content\0Length: 5"s), 400, "name"},
      {"9110 5.1", "a bracket in a name", post_with("X[1]: 5"), 400, "name"},
      {"9110 5.1", "no ASCII in a name", post_with("\xc3\xa4: 5"), 400, "name"},
      {"9112 5.2", "a folded line", post_with("X: a\r\n b"), 400, "folded"},
      {"9112 5.2", "a line folded by a tab", post_with("X: a\r\n\tContent-Length: 5"), 400, "folded"},
      {"9112 5.2", "a folded length", post_with("Content-Length:\r\n 5"), 400, "Content-Length"},
      {"9110 5.5", "NUL in a value", post_with("X: a\0b"s), 400, "control"},
      {"9110 5.5", "a control character in a value", post_with("X: a\x01"), 400, "control"},
      {"9110 5.5", "a vertical tab before a value", post_with("Content-Length:\v5"), 400, "control"},
      {"9110 5.5", "DEL in a value", post_with("X: \x7f"), 400, "control"},
      {"9112 6.3", "length and coding", post_with("Content-Length: 4\r\nTransfer-Encoding: chunked"), 400,
       "not allowed with"},
      {"9112 6.3", "coding and length", post_with("Transfer-Encoding: chunked\r\nContent-Length: 4"), 400,
       "not allowed with"},
      {"9112 6.3", "two lengths", post_with("Content-Length: 4\r\nContent-Length: 5"), 400, "twice"},
      {"9112 6.3", "a length twice", post_with("Content-Length: 4\r\ncontent-length: 4"), 400, "twice"},
      {"9112 6.3", "a list of lengths", post_with("Content-Length: 4, 4"), 400, "whole number"},
      {"9110 8.6", "a negative length", post_with("Content-Length: -1"), 400, "whole number"},
      {"9110 8.6", "a sign", post_with("Content-Length: +4"), 400, "whole number"},
      {"9110 8.6", "hexadecimal", post_with("Content-Length: 0x4"), 400, "whole number"},
      {"9110 8.6", "a letter", post_with("Content-Length: 4a"), 400, "whole number"},
      {"9110 8.6", "a fraction", post_with("Content-Length: 4.0"), 400, "whole number"},
      {"9110 8.6", "a blank in it", post_with("Content-Length: 4 4"), 400, "whole number"},
      {"9110 8.6", "quotation marks", post_with("Content-Length: \"4\""), 400, "whole number"},
      {"9110 8.6", "no length", post_with("Content-Length:"), 400, "whole number"},
      {"9110 8.6", "too great a length", post_with("Content-Length: 99999999999999999999"), 400,
       "whole number"},
      {"9110 8.6", "2^63", post_with("Content-Length: 9223372036854775808"), 400, "whole number"},
      {"9112 6.1", "another coding", post_with("Transfer-Encoding: gzip"), 400, "chunked"},
      {"9112 6.1", "two codings", post_with("Transfer-Encoding: gzip, chunked"), 400, "chunked"},
      {"9112 6.1", "chunked first", post_with("Transfer-Encoding: chunked, identity"), 400, "chunked"},
      {"9112 6.1", "chunked twice", post_with("Transfer-Encoding: chunked, chunked"), 400, "chunked"},
      {"9112 6.1", "two fields", post_with("Transfer-Encoding: chunked\r\nTransfer-Encoding: chunked"), 400,
       "chunked"},
      {"9112 6.1", "identity", post_with("Transfer-Encoding: identity"), 400, "chunked"},
      {"9112 6.1", "nearly chunked", post_with("Transfer-Encoding: xchunked"), 400, "chunked"},
      {"9112 6.1", "no coding", post_with("Transfer-Encoding:"), 400, "chunked"},
      {"9112 6.1", "in HTTP/1.0", "POST /echo HTTP/1.0\r\nTransfer-Encoding: chunked\r\n\r\n", 400,
       "HTTP/1.0"},
      {"6585 5", "a long field", post_with("X: " + std::string(HeadChecker::kMostBytes, 'x')), 431,
       "16384 bytes"},
      {"6585 5", "a long target", request_line("GET /" + std::string(17000, 'x') + " HTTP/1.1"), 431,
       "16384 bytes"},
      {"6585 5", "a long line without an end", std::string(HeadChecker::kMostBytes, 'x'), 431, "16384 bytes"},
      {"6585 5", "many fields", post_with(repeated("X: 1\r\n", 128) + "X: 1"), 431, "128"},
      {"6585 5", "many query parameters", request_line("GET /echo?" + repeated("a&", 129) + " HTTP/1.1"), 431,
       "128"},
      {"6585 5", "many cookies", post_with("Cookie: " + repeated("a=b;", 128)), 431, "128"},
      {"6585 5", "a long cookie", post_with("Cookie: a=" + std::string(4096, 'b')), 431, "Cookie"},
  };
  return kRows;
}

const std::vector<OddChunks>& odd_chunks() {
  static const std::vector<OddChunks> kRows = {
      {"0x before the size", "0x5\r\nhello\r\n0\r\n\r\n"},
      {"a plus", "+5\r\nhello\r\n0\r\n\r\n"},
      {"a minus", "-5\r\nhello\r\n0\r\n\r\n"},
      {"a blank before the size", " 5\r\nhello\r\n0\r\n\r\n"},
      {"a tab before the size", "\t5\r\nhello\r\n0\r\n\r\n"},
      {"a blank behind the size", "5 \r\nhello\r\n0\r\n\r\n"},
      {"no size", "\r\nhello\r\n0\r\n\r\n"},
      {"an extension alone", ";ext\r\nhello\r\n0\r\n\r\n"},
      {"no hexadecimal digit", "g\r\nhello\r\n0\r\n\r\n"},
      {"a digit too many", "00000000000000005\r\nhello\r\n0\r\n\r\n"},
      {"2^64", "10000000000000000\r\nhello\r\n0\r\n\r\n"},
      {"2^63", "8000000000000000\r\nhello\r\n0\r\n\r\n"},
      {"letters behind the size", "5x\r\nhello\r\n0\r\n\r\n"},
      {"a list", "5,5\r\nhello\r\n0\r\n\r\n"},
      {"bare LF behind the size", "5\nhello\r\n0\r\n\r\n"},
      {"bare LF behind an extension", "5;ext\nhello\r\n0\r\n\r\n"},
      {"CR alone behind the size", "5\rhello\r\n0\r\n\r\n"},
      {"CR in an extension", "5;a\rb\r\nhello\r\n0\r\n\r\n"},
      {"NUL in an extension", std::string("5;a\0b\r\nhello\r\n0\r\n\r\n", 20)},
      {"a long extension", "5;" + std::string(5000, 'x') + "\r\nhello\r\n0\r\n\r\n"},
      {"bare LF behind a chunk", "5\r\nhello\n0\r\n\r\n"},
      {"nothing behind a chunk", "5\r\nhello0\r\n\r\n"},
      {"more than the size says", "4\r\nhello\r\n0\r\n\r\n"},
      {"bare LF behind the last chunk", "5\r\nhello\r\n0\n\r\n"},
      {"bare LF at the end", "5\r\nhello\r\n0\r\n\n"},
      {"a trailer without a colon", "5\r\nhello\r\n0\r\nTrailer\r\n\r\n"},
      {"a blank before a trailer's colon", "5\r\nhello\r\n0\r\nTrailer : x\r\n\r\n"},
      {"a folded trailer", "5\r\nhello\r\n0\r\nTrailer: x\r\n y\r\n\r\n"},
      {"a request in the trailers", "5\r\nhello\r\n0\r\nGET /smuggled HTTP/1.1\r\n\r\n"},
      {"many trailers", "0\r\n" + repeated("X: " + std::string(1000, 'x') + "\r\n", 20) + "\r\n"},
  };
  return kRows;
}

}  // namespace adit::intake
