#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "icd/redaction.hpp"
#include "intake/server.hpp"

namespace adit::api {

using SharedRedaction = std::shared_ptr<const icd::Redaction>;
/// The one that counts, for the loop alone: tokens change while a page is open.
using PresentRedaction = std::shared_ptr<const SharedRedaction>;

/// Out of a body of that Content-Type; out of pictures, archives and the page's own files nothing.
void redact(const icd::Redaction& redaction, std::string_view content_type, std::string& body);

/// Passes answers and streams on, redacted; answers under gzip if `head` takes it and it pays (packed.hpp).
std::shared_ptr<intake::Responder> redacted(std::shared_ptr<intake::Responder> responder,
                                            PresentRedaction redaction, const intake::RequestHead& head);

}  // namespace adit::api
