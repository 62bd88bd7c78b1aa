#include "api/update_routes.hpp"

#include <utility>

#include "api/answers.hpp"
#include "api/as_json.hpp"
#include "api/small_body.hpp"
#include "codec/body_decoder.hpp"
#include "codec/field.hpp"
#include "codec/json.hpp"
#include "icd/sentence.hpp"

namespace adit::api {
namespace {

using codec::Value;

constexpr std::string_view kUpdate = "/adit/update", kStick = "/adit/update/stick",
                           kRestart = "/adit/update/restart";
constexpr std::size_t kMostBody = 1024;
/// No form of a page from elsewhere can send it without a CORS preflight, as with JSON.
constexpr std::string_view kBytes = "application/octet-stream";

Value text_or_null(const std::string& text) {
  return text.empty() ? Value{} : json(text);
}

/// A body that goes to an Upload as it comes.
class Receiving final : public intake::BodySink {
 public:
  Receiving(std::unique_ptr<Upload> upload, std::function<void(icd::Checked<void>)> done)
      : upload_(std::move(upload)), done_(std::move(done)) {}
  bool on_body(std::span<const std::uint8_t> piece) override { return upload_->write(piece); }
  void on_end() override { upload_->finish(std::move(done_)); }
  void on_gone() override { upload_.reset(); }

 private:
  std::unique_ptr<Upload> upload_;
  std::function<void(icd::Checked<void>)> done_;
};

/// The one flag that a body may have.
icd::Checked<bool> flag_in(std::string_view body, std::string_view name) {
  if (body.empty()) return false;
  const auto document = codec::decode({}, codec::Split::Nothing, body);
  if (!document) return std::unexpected(document.error());
  codec::Reading reading;
  const codec::Field root(document->root, reading);
  const codec::Field field = root.member(name);
  return reading.outcome(field.is_absent() && root.is<Value::Object>() ? false : field.truth());
}

}  // namespace

bool UpdateRoutes::has(std::string_view path) {
  return path == kUpdate || path == kStick || path == kRestart;
}

std::unique_ptr<intake::BodySink> UpdateRoutes::open(const intake::RequestHead& head,
                                                     const std::shared_ptr<intake::Responder>& responder,
                                                     std::shared_ptr<intake::Flow> flow) {
  const auto answer = [&responder](intake::Answer given) {
    responder->answer(std::move(given));
    return nullptr;
  };
  if (head.path() == kUpdate && only_reads(head)) return answer(shown());
  if (head.method() != "POST")
    return answer(wrong_method(head.path() == kUpdate ? "GET, HEAD, POST" : "POST"));
  if (head.path() == kUpdate) return receive(head, responder, std::move(flow));
  if (codec::format_of(head.header("Content-Type")) != codec::Format::Json)
    return answer(refusal(icd::Status::UnprocessableEntity, "Content-Type: expected application/json"));
  if (head.content_length().value_or(0) > kMostBody) return answer(SmallBody::too_long(kMostBody));
  return std::make_unique<SmallBody>(
      responder, kMostBody, [this, path = std::string(head.path()), responder](const std::string& body) {
        responder->answer(post(path, body));
      });
}

std::unique_ptr<intake::BodySink> UpdateRoutes::receive(const intake::RequestHead& head,
                                                        const std::shared_ptr<intake::Responder>& responder,
                                                        std::shared_ptr<intake::Flow> flow) {
  const auto refuse = [&responder](icd::Status status, std::string_view why) {
    responder->answer(refusal(status, why));
    return nullptr;
  };
  if (head.header("Content-Type") != kBytes)
    return refuse(icd::Status::UnprocessableEntity, icd::sentence("Content-Type: expected ", kBytes));
  const auto size = head.content_length();
  if (!size || *size == 0)
    return refuse(icd::Status::UnprocessableEntity, "Content-Length: expected the bundle's size");
  if (*size > update::kLargestBundle) {
    return refuse(icd::Status::ContentTooLarge,
                  icd::sentence("expected a bundle of at most ", update::kLargestBundle, " bytes"));
  }
  const std::string_view again = head.query("again");
  if (!again.empty() && again != "0" && again != "1")
    return refuse(icd::Status::UnprocessableEntity, "again: expected 0 or 1");
  auto upload = updates_.receive(*size, again == "1", [flow = std::move(flow)] { flow->resume(); });
  if (!upload) return refuse(upload.error().status, upload.error().sentence);
  changed_();
  return std::make_unique<Receiving>(std::move(*upload), [this, responder](const icd::Checked<void>& done) {
    responder->answer(after(done));
    changed_();
  });
}

intake::Answer UpdateRoutes::post(std::string_view path, const std::string& body) {
  const auto flag = flag_in(body, path == kStick ? "again" : "anyway");
  if (!flag) return refusal(flag.error().status, flag.error().sentence);
  auto answer = after(path == kStick ? updates_.install_from_stick(*flag) : updates_.restart(*flag));
  changed_();
  return answer;
}

intake::Answer UpdateRoutes::shown() const {
  const UpdateView view = updates_.update();
  const update::LastUpdate& last = view.last;
  const Value none;
  return fresh("application/json",
               codec::write_json({Value::Object{
                   {"managed", json(view.managed)},
                   {"why", json(view.why)},
                   {"board", json(view.running.compatible)},
                   {"version", json(view.running.version)},
                   {"slot", json(view.running.slot)},
                   {"trial", json(view.trial)},
                   {"doing", text_or_null(view.doing)},
                   {"progress", json(view.progress)},
                   {"refusal", text_or_null(view.refusal)},
                   {"last", last.stage == update::Stage::None
                                ? none
                                : Value{Value::Object{{"stage", json(std::string(name_of(last.stage)))},
                                                      {"version", json(last.version)},
                                                      {"slot", json(last.slot)},
                                                      {"why", json(last.why)}}}},
                   {"stick", view.stick ? Value{Value::Object{{"name", json(view.stick->name)},
                                                              {"version", json(view.stick->version)}}}
                                        : none},
                   {"stick_why", text_or_null(view.stick_why)}}}));
}

intake::Answer UpdateRoutes::after(const icd::Checked<void>& done) const {
  return done ? shown() : refusal(done.error().status, done.error().sentence);
}

}  // namespace adit::api
