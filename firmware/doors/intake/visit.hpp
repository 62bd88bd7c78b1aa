#pragma once

#include <cstdint>
#include <memory>
#include <set>
#include <utility>

#include "intake/desk.hpp"
#include "intake/server.hpp"

namespace adit::intake {

class Upload;

/// All uploads that are not over. For the loop only.
struct Uploads {
  std::set<Upload*> under_way;
  std::uint64_t last = 0;  // place of the last beginning or end (Sender::began)
};

/// One request to one of the ICD's URIs: its sender, and the responder for the answer.
struct Visit {
  Desk& desk;
  icd::Uri uri;
  Sender sender;
  std::shared_ptr<Responder> responder;
  std::shared_ptr<Uploads> uploads;

  /// The sender of an upload that is whole now.
  Sender sender_at_end() const;

  void refuse(const icd::Refusal& refusal, std::vector<Header> headers = {}) const;
  /// 200 `null`, or the refusal.
  void answer(const icd::Checked<void>& taken) const;
};

/// Passes answers on and adds only Access-Control-Allow-Origin.
std::shared_ptr<Responder> with_cors(std::shared_ptr<Responder> responder);

/// The answer to a CORS preflight (Fetch, CORS protocol): the methods of `uri` and the requested headers.
Answer preflight_answer(icd::Uri uri, std::string_view asked_headers);

/// True if `uri` allows the method. HEAD goes with GET (RFC 9110 9.3.2).
bool is_allowed(icd::Uri uri, std::string_view method);
/// "GET, HEAD, OPTIONS"
std::string allowed_methods(icd::Uri uri);

}  // namespace adit::intake
