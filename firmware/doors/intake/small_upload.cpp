#include "intake/small_upload.hpp"

#include <algorithm>

#include "codec/read.hpp"
#include "intake/take_parts.hpp"
#include "intake/type_hint.hpp"

namespace adit::intake {

bool SmallUpload::on_body(std::span<const std::uint8_t> piece) {
  visit_.sender.bytes += piece.size();
  const auto fed = decoder_.feed(piece);
  if (!fed) {
    visit_.refuse(fed.error());
  } else if (!share_.grow_to(std::max(visit_.sender.bytes, decoder_.size()))) {
    visit_.refuse({icd::Status::ServiceUnavailable,
                   "too many bytes at once, from this address or in total; send this message again later"},
                  {{"Retry-After", "1"}});
  }
  return true;
}

void SmallUpload::on_end() {
  whole_ = true;
  const auto document = decoder_.finish();
  if (!document) {
    visit_.refuse(document.error());
  } else {
    give_to_desk(*document);
  }
}

void SmallUpload::give_to_desk(const codec::Document& document) {
  if (visit_.uri == icd::Uri::StateUpdate) {
    take_parts(visit_, codec::read_state_parts(document, rules_));
  } else if (const auto read = codec::read_artifact_report(document, rules_, type_hint); read) {
    if (!read->left_out.empty()) visit_.desk.left_out(visit_.uri, visit_.sender, read->left_out);
    visit_.desk.take(read->report, visit_.sender, visit_.responder);
  } else {
    visit_.refuse(read.error());
  }
}

}  // namespace adit::intake
