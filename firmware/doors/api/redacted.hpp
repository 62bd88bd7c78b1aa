#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "icd/redaction.hpp"
#include "intake/server.hpp"

namespace adit::api {

using SharedRedaction = std::shared_ptr<const icd::Redaction>;
/// The present redaction, for use on the loop alone, because tokens change while a page is open.
using PresentRedaction = std::shared_ptr<const SharedRedaction>;

/// Redacts a body of this Content-Type. Images, archives and the page's files stay unchanged.
void redact(const icd::Redaction& redaction, std::string_view content_type, std::string& body);

/// Forwards answers and streams after redaction. Compresses answers if `head` accepts gzip and it pays
/// (packed.hpp).
std::shared_ptr<intake::Responder> redacted(std::shared_ptr<intake::Responder> responder,
                                            PresentRedaction redaction, const intake::RequestHead& head);

}  // namespace adit::api
