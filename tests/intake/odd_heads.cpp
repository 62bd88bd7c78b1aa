#include "intake/odd_heads.hpp"

#include "intake/head_checker.hpp"

namespace adit::intake {
namespace {

using namespace std::string_literals;

std::string asking(std::string_view line) {
  return std::string(line) + "\r\nHost: adit\r\n\r\n";
}

std::string with(const std::string& fields) {
  return "POST /echo HTTP/1.1\r\nHost: adit\r\n" + fields + "\r\n\r\n";
}

std::string hosted(const std::string& fields) {
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
      {"9112 2.2", "bare LF behind a field", hosted("Host: adit\nX: 1\r\n"), 400, "CRLF"},
      {"9112 2.2", "bare LF as the last line", "GET /echo HTTP/1.1\r\nHost: adit\r\n\n", 400, "CRLF"},
      {"9112 2.2", "bare LF before all", "\nGET /echo HTTP/1.1\r\nHost: adit\r\n\r\n", 400, "CRLF"},
      {"9112 2.2", "bare CR in a value", with("X: a\rContent-Length: 5"), 400, "control"},
      {"9112 2.2", "bare CR in the target", asking("GET /echo\r HTTP/1.1"), 400, "request target"},
      {"9112 2.2", "CR twice", "GET /echo HTTP/1.1\r\r\nHost: adit\r\n\r\n", 400, "request line"},
      {"9112 2.2", "a blank before the first field", hosted(" \r\nHost: adit\r\n"), 400, "folded"},
      {"9112 3", "two blanks", asking("GET  /echo HTTP/1.1"), 400, "request line"},
      {"9112 3", "two blanks before the version", asking("GET /echo  HTTP/1.1"), 400, "request line"},
      {"9112 3", "a blank behind the version", asking("GET /echo HTTP/1.1 "), 400, "request line"},
      {"9112 3", "a blank before the method", asking(" GET /echo HTTP/1.1"), 400, "request line"},
      {"9112 3", "tabs", asking("GET\t/echo\tHTTP/1.1"), 400, "request line"},
      {"9112 3", "no version", asking("GET /echo"), 400, "request line"},
      {"9112 3", "no target", asking("GET HTTP/1.1"), 400, "request line"},
      {"9112 3", "a blank in the target", asking("GET /echo more HTTP/1.1"), 400, "request line"},
      {"9112 3.1", "no token as the method", asking("G(T /echo HTTP/1.1"), 400, "request line"},
      {"9112 2.3", "another case", asking("GET /echo http/1.1"), 400, "request line"},
      {"9112 2.3", "two digits", asking("GET /echo HTTP/1.10"), 400, "request line"},
      {"9112 2.3", "another protocol", asking("GET /echo ICY/1.1"), 400, "request line"},
      {"9110 15.6.6", "an older version", asking("GET /echo HTTP/0.9"), 505, "HTTP/0.9"},
      {"9110 15.6.6", "a newer version", asking("PRI * HTTP/2.0"), 505, "HTTP/2.0"},
      {"9112 3.2", "no path", asking("GET echo HTTP/1.1"), 400, "request target"},
      {"9112 3.2.3", "a place to connect to", asking("CONNECT elsewhere:80 HTTP/1.1"), 400, "request target"},
      {"9112 3.2.4", "an asterisk", asking("GET * HTTP/1.1"), 400, "request target"},
      {"9112 3.2.2", "elsewhere", asking("GET http://elsewhere/echo HTTP/1.1"), 400, "Host"},
      {"9112 3.2.2", "another port", asking("GET http://adit:81/echo HTTP/1.1"), 400, "Host"},
      {"9112 3.2.2", "another scheme", asking("GET https://adit/echo HTTP/1.1"), 400, "request target"},
      {"9112 3.2.2", "elsewhere, no Host", "GET http://adit/echo HTTP/1.0\r\n\r\n", 400, "Host"},
      {"9110 4.2.4", "a user", asking("GET http://me@adit/echo HTTP/1.1"), 400, "Host"},
      {"3986 2", "NUL in the target", asking("GET /ec\0ho HTTP/1.1"s), 400, "request target"},
      {"3986 2", "a control character", asking("GET /ec\x01ho HTTP/1.1"), 400, "request target"},
      {"3986 2", "DEL in the target", asking("GET /ec\x7fho HTTP/1.1"), 400, "request target"},
      {"3986 2", "a tab in the target", asking("GET /ec\tho HTTP/1.1"), 400, "request target"},
      {"9112 3.2", "no Host", hosted("X: 1\r\n"), 400, "Host: missing"},
      {"9112 3.2", "two Hosts", hosted("Host: adit\r\nHost: elsewhere\r\n"), 400, "Host: given twice"},
      {"9112 3.2", "the same twice", hosted("Host: adit\r\nhost: adit\r\n"), 400, "Host: given twice"},
      {"9112 3.2", "two Hosts of HTTP/1.0", "GET /echo HTTP/1.0\r\nHost: a\r\nHost: b\r\n\r\n", 400, "twice"},
      {"9110 5.3", "two content types",
       with("Content-Type: application/json\r\nContent-Type: application/cbor"), 400,
       "Content-Type: given twice"},
      {"9110 5.3", "and another letter case", with("content-type: a/b\r\nContent-Type: a/B"), 400,
       "Content-Type: given twice"},
      {"9110 5.3", "and none", with("Content-Type: a/b\r\nContent-Type:"), 400, "Content-Type: given twice"},
      {"9110 5.3", "and the first once more",
       with("Content-Type: a/b\r\nContent-Type: a/b\r\nContent-Type: a/c"), 400, "Content-Type: given twice"},
      {"9110 5.3", "two tokens", with("Authorization: Bearer a\r\nX: 1\r\nauthorization: Bearer b"), 400,
       "Authorization: given twice"},
      {"9110 5.3", "two origins", with("Origin: null\r\nOrigin: http://adit"), 400, "Origin: given twice"},
      {"9110 8.4", "two content codings", with("Content-Encoding: gzip\r\nContent-Encoding: deflate"), 400,
       "Content-Encoding: given twice"},
      {"9110 8.4", "a content coding twice", with("Content-Encoding: gzip\r\nContent-Encoding: gzip"), 400,
       "Content-Encoding: given twice"},
      {"9110 7.2", "Host with a path", hosted("Host: adit/echo\r\n"), 400, "Host"},
      {"9110 7.2", "Host with a user", hosted("Host: me@adit\r\n"), 400, "Host"},
      {"9110 7.2", "two names in Host", hosted("Host: adit elsewhere\r\n"), 400, "Host"},
      {"9110 7.2", "no port", hosted("Host: adit:http\r\n"), 400, "Host"},
      {"9110 7.2", "an open bracket", hosted("Host: [::1\r\n"), 400, "Host"},
      {"9110 7.2", "more behind a bracket", hosted("Host: [::1]adit\r\n"), 400, "Host"},
      {"9112 5.1", "a blank before the colon", with("Content-Length : 5"), 400, "colon"},
      {"9112 5.1", "a tab before the colon", with("Content-Length\t: 5"), 400, "colon"},
      {"9112 5.1", "a blank before the colon of a coding", with("Transfer-Encoding : chunked"), 400, "colon"},
      {"9110 5.1", "no name", with(": 5"), 400, "name"},
      {"9112 5", "no colon", with("Content-Length 5"), 400, "colon"},
      {"9110 5.1", "a blank in a name", with("Content Length: 5"), 400, "name"},
      {"9110 5.1", "NUL in a name", with("Content\0Length: 5"s), 400, "name"},
      {"9110 5.1", "a bracket in a name", with("X[1]: 5"), 400, "name"},
      {"9110 5.1", "no ASCII in a name", with("\xc3\xa4: 5"), 400, "name"},
      {"9112 5.2", "a folded line", with("X: a\r\n b"), 400, "folded"},
      {"9112 5.2", "a line folded by a tab", with("X: a\r\n\tContent-Length: 5"), 400, "folded"},
      {"9112 5.2", "a folded length", with("Content-Length:\r\n 5"), 400, "Content-Length"},
      {"9110 5.5", "NUL in a value", with("X: a\0b"s), 400, "control"},
      {"9110 5.5", "a control character in a value", with("X: a\x01"), 400, "control"},
      {"9110 5.5", "a vertical tab before a value", with("Content-Length:\v5"), 400, "control"},
      {"9110 5.5", "DEL in a value", with("X: \x7f"), 400, "control"},
      {"9112 6.3", "length and coding", with("Content-Length: 4\r\nTransfer-Encoding: chunked"), 400,
       "not allowed with"},
      {"9112 6.3", "coding and length", with("Transfer-Encoding: chunked\r\nContent-Length: 4"), 400,
       "not allowed with"},
      {"9112 6.3", "two lengths", with("Content-Length: 4\r\nContent-Length: 5"), 400, "twice"},
      {"9112 6.3", "a length twice", with("Content-Length: 4\r\ncontent-length: 4"), 400, "twice"},
      {"9112 6.3", "a list of lengths", with("Content-Length: 4, 4"), 400, "whole number"},
      {"9110 8.6", "a negative length", with("Content-Length: -1"), 400, "whole number"},
      {"9110 8.6", "a sign", with("Content-Length: +4"), 400, "whole number"},
      {"9110 8.6", "hexadecimal", with("Content-Length: 0x4"), 400, "whole number"},
      {"9110 8.6", "a letter", with("Content-Length: 4a"), 400, "whole number"},
      {"9110 8.6", "a fraction", with("Content-Length: 4.0"), 400, "whole number"},
      {"9110 8.6", "a blank in it", with("Content-Length: 4 4"), 400, "whole number"},
      {"9110 8.6", "quotation marks", with("Content-Length: \"4\""), 400, "whole number"},
      {"9110 8.6", "no length", with("Content-Length:"), 400, "whole number"},
      {"9110 8.6", "too great a length", with("Content-Length: 99999999999999999999"), 400, "whole number"},
      {"9110 8.6", "2^63", with("Content-Length: 9223372036854775808"), 400, "whole number"},
      {"9112 6.1", "another coding", with("Transfer-Encoding: gzip"), 400, "chunked"},
      {"9112 6.1", "two codings", with("Transfer-Encoding: gzip, chunked"), 400, "chunked"},
      {"9112 6.1", "chunked first", with("Transfer-Encoding: chunked, identity"), 400, "chunked"},
      {"9112 6.1", "chunked twice", with("Transfer-Encoding: chunked, chunked"), 400, "chunked"},
      {"9112 6.1", "two fields", with("Transfer-Encoding: chunked\r\nTransfer-Encoding: chunked"), 400,
       "chunked"},
      {"9112 6.1", "identity", with("Transfer-Encoding: identity"), 400, "chunked"},
      {"9112 6.1", "nearly chunked", with("Transfer-Encoding: xchunked"), 400, "chunked"},
      {"9112 6.1", "no coding", with("Transfer-Encoding:"), 400, "chunked"},
      {"9112 6.1", "in HTTP/1.0", "POST /echo HTTP/1.0\r\nTransfer-Encoding: chunked\r\n\r\n", 400,
       "HTTP/1.0"},
      {"6585 5", "a long field", with("X: " + std::string(HeadChecker::kMostBytes, 'x')), 431, "16384 bytes"},
      {"6585 5", "a long target", asking("GET /" + std::string(17000, 'x') + " HTTP/1.1"), 431,
       "16384 bytes"},
      {"6585 5", "a long line without an end", std::string(HeadChecker::kMostBytes, 'x'), 431, "16384 bytes"},
      {"6585 5", "many fields", with(repeated("X: 1\r\n", 128) + "X: 1"), 431, "128"},
      {"6585 5", "many query parameters", asking("GET /echo?" + repeated("a&", 129) + " HTTP/1.1"), 431,
       "128"},
      {"6585 5", "many cookies", with("Cookie: " + repeated("a=b;", 128)), 431, "128"},
      {"6585 5", "a long cookie", with("Cookie: a=" + std::string(4096, 'b')), 431, "Cookie"},
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
