#include "api/answers.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <span>
#include <string>
#include <utility>

#include "codec/gzip.hpp"
#include "codec/json.hpp"
#include "icd/sentence.hpp"
#include "icd/suggestion.hpp"
#include "icd/text.hpp"
#include "icd/uri.hpp"
#include "intake/answer.hpp"

namespace adit::api {
namespace {

constexpr std::size_t kFewestPacked = 1400;  // a smaller body fits one packet anyway
constexpr std::size_t kMostPacked = 1u << 20;

/// Removes and returns the trimmed text before the next `mark`; `text` becomes the rest.
std::string_view split_off(std::string_view& text, char mark) {
  return icd::trim(icd::cut(text, mark), " \t");
}

/// "q=0", "q=0.0": not acceptable.
bool is_forbidden(std::string_view weight) {
  if (!weight.starts_with("q=") && !weight.starts_with("Q=")) return false;
  return weight.substr(2).find_first_not_of("0.") == std::string_view::npos;
}

bool has_header(const intake::Answer& answer, std::string_view name) {
  return std::ranges::find(answer.headers, name, &intake::Header::name) != answer.headers.end();
}

bool is_worth_packing(const intake::Answer& answer) {
  const std::string_view type = answer.content_type;
  const bool is_text = type.starts_with("text/") || type.starts_with("application/json");
  return is_text && answer.body.size() >= kFewestPacked && answer.body.size() <= kMostPacked &&
         !is_packed(answer) && !has_header(answer, "ETag");
}

}  // namespace

bool accepts_gzip(std::string_view accept_encoding) {
  bool any = false;
  while (!accept_encoding.empty()) {
    auto coding = split_off(accept_encoding, ',');
    const auto name = split_off(coding, ';');
    const bool taken = !is_forbidden(icd::trim(coding, " \t"));
    if (icd::equals_ignoring_case(name, "gzip") || icd::equals_ignoring_case(name, "x-gzip")) return taken;
    if (name == "*") any = taken;
  }
  return any;
}

bool is_packed(const intake::Answer& answer) {
  return has_header(answer, "Content-Encoding");
}

void pack_if_worthwhile(intake::Answer& answer) {
  if (!is_worth_packing(answer)) return;
  answer.headers.push_back({"Vary", "Accept-Encoding"});
  const std::span bytes(reinterpret_cast<const std::uint8_t*>(answer.body.data()), answer.body.size());
  const auto member = codec::gzip(bytes, codec::kFastestLevel, bytes.size());
  if (!member) return;  // it would be longer
  answer.body = member->to_string();
  answer.headers.push_back({"Content-Encoding", "gzip"});
}

namespace {

/// The page may load and call only its own files, and no page may frame it.
constexpr const char* kContentSecurityPolicy =
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self'; connect-src 'self'; "
    "worker-src 'self'; base-uri 'none'; frame-ancestors 'none'; form-action 'none'";

}  // namespace

intake::Answer add_headers(intake::Answer answer) {
  answer.headers.push_back({"Content-Security-Policy", kContentSecurityPolicy});
  answer.headers.push_back({"X-Content-Type-Options", "nosniff"});
  answer.headers.push_back({"Referrer-Policy", "no-referrer"});
  return answer;
}

intake::Answer uncached_answer(std::string content_type, std::string body) {
  return add_headers({.content_type = std::move(content_type),
                      .body = std::move(body),
                      .headers = {{"Cache-Control", "no-store"}}});
}

intake::Answer object(codec::Value::Object members) {
  return uncached_answer("application/json", codec::write_json({std::move(members)}));
}

intake::Answer download(intake::Answer answer, const std::string& name) {
  answer.headers.push_back({"Content-Disposition", "attachment; filename=\"" + name + "\""});
  return answer;
}

intake::Answer refusal_answer(const icd::Refusal& why) {
  return refusal(why.status, why.sentence);
}

intake::Answer refusal_answer(const std::vector<settings::Error>& errors) {
  return refusal(icd::Status::UnprocessableEntity, settings::sentence_of(errors));
}

intake::Answer refused_change(const icd::Refusal& why) {
  auto answer = refusal_answer(why);
  if (why.status == icd::Status::Conflict) answer.headers.push_back({"Retry-After", "1"});
  return answer;
}

intake::Answer refusal(icd::Status status, std::string_view sentence) {
  return add_headers(intake::error_answer(status, sentence));
}

icd::Refusal nothing_at(std::string_view path) {
  static constexpr auto kPaths = [] {
    std::array<std::string_view, std::size(icd::kUris)> paths;
    std::ranges::transform(icd::kUris, paths.begin(), icd::path_of);
    return paths;
  }();
  return {icd::Status::NotFound,
          icd::sentence("there is no resource at ", icd::quote_text(path), icd::did_you_mean(path, kPaths))};
}

intake::Answer wrong_method(std::string_view allowed) {
  const auto first = allowed.substr(0, allowed.find(','));
  auto answer = refusal(icd::Status::MethodNotAllowed, icd::sentence("expected ", first));
  answer.headers.push_back({"Allow", std::string(allowed)});
  return answer;
}

namespace {

constexpr std::string_view kEvents = "text/event-stream";

class RedactedStream final : public intake::Stream {
 public:
  RedactedStream(std::shared_ptr<intake::Stream> stream, PresentRedaction redaction)
      : stream_(std::move(stream)), redaction_(std::move(redaction)) {}
  bool send(std::string_view bytes) override { return stream_->send(redact_bytes(bytes)); }
  bool send_instead(std::string_view bytes) override { return stream_->send_instead(redact_bytes(bytes)); }
  std::size_t waiting() const override { return stream_->waiting(); }

 private:
  std::string redact_bytes(std::string_view bytes) const {
    std::string text(bytes);
    redact(**redaction_, kEvents, text);
    return text;
  }

  const std::shared_ptr<intake::Stream> stream_;
  const PresentRedaction redaction_;
};

class RedactedResponder final : public intake::PassingResponder {
 public:
  RedactedResponder(std::shared_ptr<intake::Responder> responder, PresentRedaction redaction, bool takes_gzip)
      : PassingResponder(std::move(responder)), redaction_(std::move(redaction)), takes_gzip_(takes_gzip) {}
  void answer(intake::Answer answer) override {
    if (!is_packed(answer)) redact(**redaction_, answer.content_type, answer.body);
    if (takes_gzip_) pack_if_worthwhile(answer);
    inner().answer(std::move(answer));
  }
  std::shared_ptr<intake::Stream> stream(std::string_view content_type) override {
    auto stream = inner().stream(content_type);
    if (!stream || content_type != kEvents) return stream;
    return std::make_shared<RedactedStream>(std::move(stream), redaction_);
  }

 private:
  const PresentRedaction redaction_;
  const bool takes_gzip_;
};

}  // namespace

void redact(const icd::Redaction& redaction, std::string_view content_type, std::string& body) {
  const bool is_metrics = content_type.starts_with("text/plain; version=");
  if (content_type == "application/json" || content_type == kEvents || is_metrics) {
    redaction.strike_from_strings(body);
  } else if (content_type.starts_with("text/csv") || content_type.starts_with("text/plain")) {
    redaction.strike_from(body);
  } else if (content_type.starts_with("text/html")) {
    redaction.strike_from_html(body);
  }
}

std::shared_ptr<intake::Responder> redact_answers(std::shared_ptr<intake::Responder> responder,
                                                  PresentRedaction redaction,
                                                  const intake::RequestHead& head) {
  return std::make_shared<RedactedResponder>(std::move(responder), std::move(redaction),
                                             accepts_gzip(head.header("Accept-Encoding")));
}

}  // namespace adit::api
