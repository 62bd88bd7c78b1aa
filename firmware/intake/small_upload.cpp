#include "intake/small_upload.hpp"

#include "codec/read.hpp"

namespace adit::intake {

bool SmallUpload::on_body(std::span<const std::uint8_t> piece) {
  visit_.sender.bytes += piece.size();
  if (const auto fed = decoder_.feed(piece); !fed) visit_.refuse(fed.error());
  return true;
}

void SmallUpload::on_end() {
  const auto document = decoder_.finish();
  if (!document) {
    visit_.refuse(document.error());
  } else {
    give_to_desk(*document);
  }
}

void SmallUpload::give_to_desk(const codec::Document& document) {
  const auto take = [this](const auto& message) {
    visit_.answer(message ? visit_.desk.take(*message, visit_.sender) : std::unexpected(message.error()));
  };
  if (visit_.uri == icd::Uri::StateUpdate) {
    take(codec::read_state_update(document, rules_));
  } else if (visit_.uri == icd::Uri::MarkersUpdate) {
    take(codec::read_markers_update(document, rules_));
  } else if (const auto report = codec::read_artifact_report(document, rules_); report) {
    visit_.desk.take(*report, visit_.sender, visit_.responder);
  } else {
    visit_.refuse(report.error());
  }
}

}  // namespace adit::intake
