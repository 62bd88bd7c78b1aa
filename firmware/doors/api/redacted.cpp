#include "api/redacted.hpp"

#include <utility>

#include "api/packed.hpp"

namespace adit::api {
namespace {

constexpr std::string_view kEvents = "text/event-stream";

class RedactedStream final : public intake::Stream {
 public:
  RedactedStream(std::shared_ptr<intake::Stream> stream, PresentRedaction redaction)
      : stream_(std::move(stream)), redaction_(std::move(redaction)) {}
  bool send(std::string_view bytes) override { return stream_->send(struck(bytes)); }
  bool send_instead(std::string_view bytes) override { return stream_->send_instead(struck(bytes)); }
  std::size_t waiting() const override { return stream_->waiting(); }

 private:
  std::string struck(std::string_view bytes) const {
    std::string text(bytes);
    redact(**redaction_, kEvents, text);
    return text;
  }

  const std::shared_ptr<intake::Stream> stream_;
  const PresentRedaction redaction_;
};

class RedactedResponder final : public intake::Responder {
 public:
  RedactedResponder(std::shared_ptr<intake::Responder> responder, PresentRedaction redaction, bool takes_gzip)
      : responder_(std::move(responder)), redaction_(std::move(redaction)), takes_gzip_(takes_gzip) {}
  void answer(intake::Answer answer) override {
    if (!is_packed(answer)) redact(**redaction_, answer.content_type, answer.body);
    if (takes_gzip_) pack_if_it_pays(answer);
    responder_->answer(std::move(answer));
  }
  std::shared_ptr<intake::Stream> stream(std::string_view content_type) override {
    auto stream = responder_->stream(content_type);
    if (!stream || content_type != kEvents) return stream;
    return std::make_shared<RedactedStream>(std::move(stream), redaction_);
  }
  bool client_gone() const override { return responder_->client_gone(); }

 private:
  const std::shared_ptr<intake::Responder> responder_;
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

std::shared_ptr<intake::Responder> redacted(std::shared_ptr<intake::Responder> responder,
                                            PresentRedaction redaction, const intake::RequestHead& head) {
  return std::make_shared<RedactedResponder>(std::move(responder), std::move(redaction),
                                             takes_gzip(head.header("Accept-Encoding")));
}

}  // namespace adit::api
