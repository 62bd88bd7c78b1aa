#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "icd/bearer_token.hpp"
#include "icd/rules.hpp"
#include "intake/message_handler.hpp"
#include "intake/server.hpp"
#include "intake/uploads.hpp"
#include "loop/workers.hpp"

namespace adit::intake {

struct IcdOptions {
  std::vector<icd::BearerToken> tokens;  // each is valid
  bool asks_token = true;  // true: a client must show a token; if `tokens` is empty, each client gets 401
  std::vector<std::string> origins;  // their pages need no token if clients need no token
  icd::Rules rules;
  // Limits for all arriving messages together: UploadBudget. Maps are in files, the others in memory.
  std::size_t upload_bytes = 512u << 20;  // maps
  std::size_t marker_bytes = 64u << 20;   // markers
  std::size_t small_bytes = 32u << 20;    // states and reports
};

/// Serves the ICD's five URIs to the team: checks tokens, methods and content types, handles CORS, decodes
/// the body and answers. Workers decode maps, chunk by chunk with back-pressure, and large markers. The loop
/// decodes the rest. Other paths go to `other`.
///
/// Even if clients need no token, a web page (whose browser sends an Origin) needs one, unless it is a page
/// of the box or of IcdOptions::origins. Otherwise each page in a teammate's browser could use up reports.
///
/// Each error is a JSON string. CORS preflights (OPTIONS) get 204 without a token, also for a URI that does
/// not exist, so that a page can read the 404.
///
/// `message_handler`, `workers` and `other` must outlive each Server that uses this handler.
class IcdRoutes final : public Handler {
 public:
  IcdRoutes(IcdOptions options, MessageHandler& message_handler, loop::Workers& workers, Handler& other);

  Credentials read_credentials(const RequestHead& head) override;
  std::unique_ptr<BodySink> open(const RequestHead& head, std::shared_ptr<Responder> responder,
                                 std::shared_ptr<FlowControl> flow) override;

  /// Sets the options for new requests. `upload_bytes`, `marker_bytes` and `small_bytes` do not change.
  void serve_with(IcdOptions options) { options_ = std::move(options); }

  /// Accepts no more messages: clients that are sending one, or send a map, a state or markers later, get
  /// 503. The message handler rejects reports whose body is whole.
  void stop();

 private:
  /// True if the request needs no token.
  bool is_free(const RequestHead& head) const;
  bool has_token(const RequestHead& head) const;
  /// 401 or 403 if the request needs a right token and has none.
  icd::Checked<void> check_entry(const RequestHead& head) const;
  /// Accepts a request. The refusal is the sender's answer.
  icd::Checked<std::unique_ptr<BodySink>> accept_upload(UploadContext& context, const RequestHead& head,
                                                        std::shared_ptr<FlowControl> flow);
  /// The head of a message with a body: the body's kind, and into `context` whether it is a resubmission.
  icd::Checked<codec::BodyKind> read_head(UploadContext& context, const RequestHead& head) const;
  /// The most bytes of a body sent to `uri`.
  std::size_t most_bytes(icd::Uri uri) const;

  IcdOptions options_;
  MessageHandler& message_handler_;
  loop::Workers& workers_;
  Handler& other_;
  std::shared_ptr<UploadBudget> maps_;
  std::shared_ptr<UploadBudget> markers_;
  std::shared_ptr<UploadBudget> small_;         // for states and reports
  std::shared_ptr<UploadBudget> without_room_;  // for maps that cannot be stored
  std::shared_ptr<TurnQueue> large_markers_ = std::make_shared<TurnQueue>();
  std::shared_ptr<Uploads> uploads_ = std::make_shared<Uploads>();
  bool stopping_ = false;
};

}  // namespace adit::intake
