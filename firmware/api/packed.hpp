#pragma once

#include <memory>
#include <string_view>

#include "intake/server.hpp"

namespace adit::api {

/// Whether a client whose Accept-Encoding this is takes gzip (RFC 9110 12.5.3); one that sends none is not
/// given it, as scripts mean it.
bool takes_gzip(std::string_view accept_encoding);

/// Whether an answer's body is under gzip already.
bool is_packed(const intake::Answer& answer);

/// Answers through `responder`, under gzip where the client takes it and it pays: text and JSON of some kB up
/// to 1 MiB, for it is done on the loop (2 ms for each 256 KiB on a desk machine). What has an ETag goes as
/// it is, for that names these bytes.
std::shared_ptr<intake::Responder> packing(std::shared_ptr<intake::Responder> responder,
                                           const intake::RequestHead& head);

}  // namespace adit::api
