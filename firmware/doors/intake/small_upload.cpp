#include "intake/small_upload.hpp"

#include <algorithm>

#include "codec/read.hpp"
#include "icd/require.hpp"
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
  switch (visit_.uri) {
    case icd::Uri::StateUpdate:
      return take_parts(visit_, codec::read_state_parts(document, rules_));
    case icd::Uri::ArtifactReports:
      return take_report(document);
    case icd::Uri::Status:
    case icd::Uri::MapUpdate:
    case icd::Uri::MarkersUpdate:
      icd::require(false);
  }
}

void SmallUpload::take_report(const codec::Document& document) {
  const auto read = codec::read_artifact_report(document, rules_, type_hint);
  if (!read) return visit_.refuse(read.error());
  if (!read->left_out.empty()) visit_.desk.left_out(visit_.uri, visit_.sender, read->left_out);
  visit_.desk.take(read->report, visit_.sender, visit_.responder);
}

}  // namespace adit::intake
