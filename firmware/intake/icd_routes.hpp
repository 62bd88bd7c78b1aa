#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "icd/bearer_token.hpp"
#include "icd/rules.hpp"
#include "intake/desk.hpp"
#include "intake/one_at_a_time.hpp"
#include "intake/server.hpp"
#include "intake/upload.hpp"
#include "loop/workers.hpp"

namespace adit::intake {

class UploadBudget;
struct Visit;

/// What the team's side of the ICD is served with.
struct IcdOptions {
  std::vector<icd::BearerToken> tokens;  // any of them is good
  bool asks_token = true;                // whether a client has to show one: without any, none is let in
  std::vector<std::string> origins;      // whose pages need none where clients need none
  icd::Rules rules;
  std::size_t upload_bytes = 512u << 20;  // most that all maps and markers under way may take: UploadBudget
  std::size_t small_bytes = 32u << 20;    // and all states and reports
};

/// The ICD's five URIs for the team: tokens, methods, content types, CORS, decoding (maps on a worker, chunk
/// by chunk with back-pressure; large markers on one, too; the rest on the loop), and the answer. Any other
/// path goes to `other`.
///
/// Where clients need no token, a web page (whose browser sends an Origin) still does, unless it is the box's
/// own or of IcdOptions::origins: else any page that is open in a teammate's browser could spend reports.
///
/// Every error is a JSON string. CORS preflights (OPTIONS) are answered 204 without a token; every answer of
/// an ICD URI carries Access-Control-Allow-Origin.
///
/// `desk`, `workers` and `other` outlive every Server that this serves.
class IcdRoutes final : public Handler {
 public:
  IcdRoutes(IcdOptions options, Desk& desk, loop::Workers& workers, Handler& other);

  Shown shown(const RequestHead& head) override;
  std::unique_ptr<BodySink> open(const RequestHead& head, std::shared_ptr<Responder> responder,
                                 std::shared_ptr<Flow> flow) override;

  /// Whoever comes from now on is served so. `upload_bytes` and `small_bytes` stay what they were.
  void serve_with(IcdOptions options) { options_ = std::move(options); }

  /// Takes no message in any more: who is in the middle of one, or comes with a map, a state or markers, is
  /// told 503. (A report whose body is whole is the desk's to refuse.)
  void stop();

 private:
  /// 401 or 403 if the request has to have a token and has none that is good.
  bool is_free(const RequestHead& head) const;
  bool has_token(const RequestHead& head) const;
  icd::Checked<void> check_entry(const RequestHead& head) const;
  std::unique_ptr<BodySink> take_in(Visit visit, const RequestHead& head, std::shared_ptr<Flow> flow);
  /// The most that a body sent to `uri` may have.
  std::size_t most_bytes(icd::Uri uri) const;

  IcdOptions options_;
  Desk& desk_;
  loop::Workers& workers_;
  Handler& other_;
  std::shared_ptr<UploadBudget> budget_;
  std::shared_ptr<UploadBudget> small_;         // for states and reports
  std::shared_ptr<UploadBudget> without_room_;  // for maps that cannot be stored
  std::shared_ptr<OneAtATime> large_markers_ = std::make_shared<OneAtATime>();
  std::shared_ptr<Upload::UnderWay> under_way_ = std::make_shared<Upload::UnderWay>();
  bool stopping_ = false;
};

/// An error answer of this gateway: `sentence` as a JSON string.
Answer error_answer(icd::Status status, std::string_view sentence);

}  // namespace adit::intake
