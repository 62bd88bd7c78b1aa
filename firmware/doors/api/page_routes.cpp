#include "api/page_routes.hpp"

#include <span>
#include <string>
#include <utility>

#include "api/answers.hpp"
#include "codec/gzip.hpp"
#include "site/site.hpp"

namespace adit::api {
namespace {

constexpr std::size_t kMostInflated = 1u << 20;

icd::Checked<std::string> inflate_file(const site::File& file) {
  const std::span bytes(reinterpret_cast<const std::uint8_t*>(file.packed.data()), file.packed.size());
  std::string text;
  const auto size = codec::gunzip(icd::ChunkedBytes(bytes), kMostInflated, file.path,
                                  [&text](std::span<const std::uint8_t> piece) {
                                    text.append(piece.begin(), piece.end());
                                    return icd::Checked<void>{};
                                  });
  if (!size) return std::unexpected(size.error());
  return text;
}

constexpr const char* kForGood = "public, max-age=31536000, immutable";  // RFC 8246
constexpr const char* kAskEachTime = "no-cache";                         // revalidated each time

/// An embedded file, compressed as stored, or inflated for a client without gzip.
intake::Answer answer_with(const site::File& file, const intake::RequestHead& head) {
  const bool as_it_is = accepts_gzip(head.header("Accept-Encoding"));
  const std::string etag = '"' + std::string(file.etag) + (as_it_is ? "-gzip\"" : "\"");  // of these bytes
  intake::Answer answer{.content_type = std::string(site::content_type_of(file)), .body = {}, .headers = {}};
  answer.headers.push_back({"ETag", etag});
  answer.headers.push_back({"Cache-Control", file.is_hashed ? kForGood : kAskEachTime});
  answer.headers.push_back({"Vary", "Accept-Encoding"});
  if (head.header("If-None-Match").contains(etag)) {
    answer.status = kNotModified;
  } else if (as_it_is) {
    answer.headers.push_back({"Content-Encoding", "gzip"});
    answer.body = file.packed;
  } else {
    auto text = inflate_file(file);
    if (!text) return refusal_answer(text.error());
    answer.body = std::move(*text);
  }
  return add_headers(std::move(answer));
}

}  // namespace

intake::Answer PageRoutes::file(const intake::RequestHead& head) const {
  const auto* const file = site::file_at(head.path());
  if (file == nullptr) return refusal_answer(nothing_at(head.path()));
  return is_read_only(head) ? answer_with(*file, head) : wrong_method(kReading);
}

intake::Answer PageRoutes::description(const intake::RequestHead& head) const {
  return answer_with(open_api::description(), head);
}

}  // namespace adit::api
