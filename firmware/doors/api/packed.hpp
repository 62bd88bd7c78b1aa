#pragma once

#include <string_view>

#include "intake/server.hpp"

namespace adit::api {

/// Whether a client with this Accept-Encoding accepts gzip (RFC 9110 12.5.3). Without the header it does not,
/// because scripts expect plain text.
bool takes_gzip(std::string_view accept_encoding);

/// Whether an answer's body is compressed by gzip.
bool is_packed(const intake::Answer& answer);

/// Compresses an answer's body with gzip if that pays: text and JSON of some kB up to 1 MiB. The limit exists
/// because the loop does it (2 ms for each 256 KiB on a desk machine). A body with an ETag stays unchanged,
/// because the ETag names its bytes.
void pack_if_it_pays(intake::Answer& answer);

}  // namespace adit::api
