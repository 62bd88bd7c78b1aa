#include "api/spare_routes.hpp"

#include <utility>

#include "api/after.hpp"
#include "api/answers.hpp"
#include "api/read_body.hpp"
#include "api/small_body.hpp"
#include "icd/sentence.hpp"
#include "spare/sealed.hpp"

namespace adit::api {
namespace {

constexpr const char* kFileName = "export.adit-spare";

/// Receives an export. Rejects other data by its first bytes and discards the rest.
class ReceivingExport final : public intake::BodySink {
 public:
  explicit ReceivingExport(std::function<void(icd::Checked<std::string>)> done) : done_(std::move(done)) {}

  bool on_body(std::span<const std::uint8_t> piece) override {
    if (!done_) return true;
    file_.append(reinterpret_cast<const char*>(piece.data()), piece.size());
    if (file_.size() >= spare::kExportHead) refuse_what_is_none();
    return true;
  }
  void on_end() override {
    if (done_) refuse_what_is_none();
    if (done_) std::exchange(done_, nullptr)(std::move(file_));
  }

 private:
  void refuse_what_is_none() {
    const std::string why = spare::not_an_export(std::string_view(file_).substr(0, spare::kExportHead));
    if (why.empty()) return;
    file_.clear();
    std::exchange(done_, nullptr)(icd::unprocessable(why));
  }

  std::function<void(icd::Checked<std::string>)> done_;
  std::string file_;
};

}  // namespace

namespace spare_routes {

void exported(Spare& spare, const Call& call) {
  spare.export_to([responder = call.responder](icd::Checked<std::string> file) {
    if (!file) return responder->answer(refused(file.error()));
    auto answer = fresh("application/octet-stream", *std::move(file));
    answer.headers.push_back(
        {"Content-Disposition", std::string("attachment; filename=\"") + kFileName + "\""});
    responder->answer(std::move(answer));
  });
}

void to_stick(Spare& spare, const Call& call) {
  spare.export_to_stick([&spare, responder = call.responder](const icd::Checked<void>& done) {
    responder->answer(after(spare, done));
  });
}

std::unique_ptr<intake::BodySink> take_in(Spare& spare, const Call& call) {
  if (call.head.content_length().value_or(spare::kLargestExport + 1) > spare::kLargestExport) {
    call.responder->answer(SmallBody::too_long(spare::kLargestExport, "export"));
    return nullptr;
  }
  return std::make_unique<ReceivingExport>(
      [&spare, responder = call.responder](icd::Checked<std::string> file) {
        responder->answer(file ? after(spare, spare.take_in(*std::move(file))) : refused(file.error()));
      });
}

void open(Spare& spare, const Call& call) {
  const auto code = read_text(call.body, "code");
  if (!code) return call.responder->answer(refused(code.error()));
  spare.open(*code, [&spare, responder = call.responder](const icd::Checked<void>& done) {
    responder->answer(after(spare, done));
  });
}

intake::Answer take_over(Spare& spare, const std::string& body) {
  const auto unplugged =
      read_body<bool>(body, [](const codec::Field& root) { return root.member("unplugged").truth(); });
  if (!unplugged) return refused(unplugged.error());
  if (!*unplugged)
    return refusal(icd::Status::UnprocessableEntity,
                   "unplugged: expected true, because the box that made the export must be off");
  return after(spare, spare.take_over());
}

}  // namespace spare_routes
}  // namespace adit::api
