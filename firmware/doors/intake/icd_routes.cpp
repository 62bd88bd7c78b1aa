#include "intake/icd_routes.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "access/admission.hpp"
#include "codec/body_decoder.hpp"
#include "icd/sentence.hpp"
#include "icd/text.hpp"
#include "icd/try.hpp"
#include "intake/answer.hpp"
#include "intake/head.hpp"

namespace adit::intake {
namespace {

constexpr std::size_t kSmallBody = codec::Limits{}.text_bytes;

/// A field's value as shown in a sentence.
std::string field_text(std::string_view text) {
  return text.empty() ? "none" : icd::quote_text(text);
}

/// GET /api/status. Ignores a body.
class StatusSink final : public BodySink {
 public:
  explicit StatusSink(UploadContext context) : context_(std::move(context)) {}
  bool on_body(std::span<const std::uint8_t>) override { return true; }
  void on_end() override { context_.message_handler.status(context_.sender, context_.responder); }

 private:
  UploadContext context_;
};

/// ICD 4: JSON or CBOR for mapping, JSON only for scoring.
icd::Checked<codec::BodyKind> kind_of(icd::Uri uri, const RequestHead& head) {
  const std::string_view type = head.header("Content-Type");
  const auto format = codec::format_of(type);
  const bool scoring = icd::endpoint_of(uri) == icd::Endpoint::Scoring;
  if (!format || (scoring && *format != codec::Format::Json)) {
    const std::string_view expected = scoring ? "application/json" : "application/json or application/cbor";
    return icd::unprocessable("Content-Type: expected ", expected, ", got ", field_text(type));
  }
  const std::string_view encoding = head.header("Content-Encoding");
  const auto coding = codec::coding_of(encoding);
  if (!coding) {
    return icd::unprocessable("Content-Encoding: expected gzip, deflate or no such header, got ",
                              field_text(encoding));
  }
  return codec::BodyKind{.format = *format, .coding = *coding};
}

/// True for Adit-Resubmit: yes, in any letter case. False if it is absent.
icd::Checked<bool> resubmits_of(const RequestHead& head) {
  const std::string_view word = head.header("Adit-Resubmit");
  if (word.empty()) return false;
  if (icd::equals_ignoring_case(word, "yes")) return true;
  return icd::unprocessable("Adit-Resubmit: expected yes or no such header, got ", icd::quote_text(word));
}

/// Accepts pages of this box and of `origins`. Without the check of Host, a page whose name resolves to the
/// box (DNS rebinding) would count as a page of the box.
icd::Checked<void> check_origin(const RequestHead& head, const std::vector<std::string>& origins) {
  const std::string_view origin = head.header("Origin"), host = head.header("Host");
  const auto needs_token = [](std::string why, std::string_view setting = "") {
    return std::unexpected(
        icd::Refusal{.status = icd::Status::Forbidden, .sentence = std::move(why), .setting = setting});
  };
  if (!access::names_this_box(host)) {
    return needs_token(
        icd::sentence("Host: expected the box's address, localhost, its name in .local, or the team's token, "
                      "because the request has the Origin ",
                      icd::quote_text(origin), ", got ", icd::quote_text(host)));
  }
  const bool is_listed = std::ranges::any_of(
      origins, [origin](const std::string& each) { return icd::equals_ignoring_case(each, origin); });
  if (is_listed || access::is_same_origin(origin, host, head.is_secure())) return {};
  return needs_token(icd::sentence("Origin: a page of ", icd::quote_text(origin),
                                   " needs the team's token, or an entry in the setting team.origins"),
                     "team.origins");
}

icd::Refusal stopping_refusal() {
  return {icd::Status::ServiceUnavailable,
          "the box is stopping; this message was not accepted, send it again"};
}

/// ", got no such header" or ", got Basic" for a header without a bearer token; "" for a wrong one. Never
/// shows a possible token.
std::string describe_credentials(std::string_view authorization) {
  if (authorization.empty()) return ", got no such header";
  if (!icd::token_in(authorization).empty()) return "";
  const std::string_view first = authorization.substr(0, authorization.find(' '));
  for (const std::string_view scheme : {"Basic", "Digest", "Token"}) {
    if (icd::equals_ignoring_case(first, scheme)) return icd::sentence(", got ", scheme);
  }
  return ", got no bearer token";
}

constexpr std::string_view kHeadersOfClients = "authorization, content-type, content-encoding";
constexpr std::size_t kLongestHeaderList = 512;

/// Field names (RFC 9110 5.6.2 tokens) with commas and blanks between them.
bool is_token_list(std::string_view text) {
  return !text.empty() && text.size() <= kLongestHeaderList && std::ranges::all_of(text, [](char letter) {
    return is_token_letter(letter) || letter == ',' || kBlanks.contains(letter);
  });
}

/// HEAD goes with GET (RFC 9110 9.3.2).
bool is_allowed(icd::Uri uri, std::string_view method) {
  return method == icd::method_of(uri) || (method == "HEAD" && icd::method_of(uri) == "GET");
}

/// "GET, HEAD, OPTIONS"
std::string allowed_methods(icd::Uri uri) {
  return icd::sentence(icd::method_of(uri), is_allowed(uri, "HEAD") ? ", HEAD" : "", ", OPTIONS");
}

/// The answer to a CORS preflight (Fetch, CORS protocol): `methods` and the requested headers.
Answer preflight_answer(std::string methods, const RequestHead& head) {
  const std::string_view asked_headers = head.header("Access-Control-Request-Headers");
  const std::string_view headers = is_token_list(asked_headers) ? asked_headers : kHeadersOfClients;
  return {.status = icd::Status::NoContent,
          .body = {},
          .headers = {{"Access-Control-Allow-Methods", std::move(methods)},
                      {"Access-Control-Allow-Headers", std::string(headers)},
                      {"Access-Control-Max-Age", "86400"}}};
}

/// Answers the preflight for a URI that does not exist. Without it a page cannot read the 404.
class PreflightResponder final : public PassingResponder {
 public:
  PreflightResponder(std::shared_ptr<Responder> responder, const RequestHead& head)
      : PassingResponder(std::move(responder)), preflight_(preflight_answer("GET, POST", head)) {
    allow_any_origin(preflight_);
  }
  void answer(Answer answer) override {
    inner().answer(answer.status == icd::Status::NotFound ? std::move(preflight_) : std::move(answer));
  }

 private:
  Answer preflight_;
};

bool is_preflight_elsewhere(const RequestHead& head) {
  return head.method() == "OPTIONS" && !head.header("Access-Control-Request-Method").empty() &&
         !head.path().starts_with(kApiPaths);
}

}  // namespace

IcdRoutes::IcdRoutes(IcdOptions options, MessageHandler& message_handler, loop::Workers& workers,
                     Handler& other)
    : options_(std::move(options)),
      message_handler_(message_handler),
      workers_(workers),
      other_(other),
      maps_(std::make_shared<UploadBudget>(options_.upload_bytes)),
      markers_(std::make_shared<UploadBudget>(options_.marker_bytes)),
      small_(std::make_shared<UploadBudget>(options_.small_bytes)),
      without_room_(std::make_shared<UploadBudget>(MapUpload::kWithoutRoom)) {}

Credentials IcdRoutes::read_credentials(const RequestHead& head) {
  if (!icd::uri_of(head.path())) return other_.read_credentials(head);
  // A preflight has no token.
  if (head.method() == "OPTIONS") return options_.asks_token ? Credentials::Nothing : Credentials::Enough;
  if (is_free(head)) return Credentials::Enough;
  return has_token(head) ? Credentials::Token : Credentials::WrongToken;
}

bool IcdRoutes::has_token(const RequestHead& head) const {
  return icd::is_one_of(options_.tokens, icd::token_in(head.header("Authorization")));
}

bool IcdRoutes::is_free(const RequestHead& head) const {
  if (options_.asks_token) return false;
  return head.header("Origin").empty() || check_origin(head, options_.origins);
}

icd::Checked<void> IcdRoutes::check_entry(const RequestHead& head) const {
  if (is_free(head) || has_token(head)) return {};
  if (!options_.asks_token) return check_origin(head, options_.origins);
  if (options_.tokens.empty())
    return icd::refuse(icd::Status::Unauthorized, "Authorization: no token is set on this box yet");
  return icd::refuse(icd::Status::Unauthorized, "Authorization: expected Bearer and the team's token",
                     describe_credentials(head.header("Authorization")));
}

std::size_t IcdRoutes::most_bytes(icd::Uri uri) const {
  switch (uri) {
    case icd::Uri::MapUpdate:
      return options_.rules.map_bytes / 3 * 4 + kSmallBody;  // base64
    case icd::Uri::MarkersUpdate:
      return MarkersUpload::kMost;
    case icd::Uri::Status:
    case icd::Uri::ArtifactReports:
    case icd::Uri::StateUpdate:
      break;
  }
  return kSmallBody;
}

std::unique_ptr<BodySink> IcdRoutes::open(const RequestHead& head, std::shared_ptr<Responder> responder,
                                          std::shared_ptr<FlowControl> flow) {
  const auto uri = icd::uri_of(head.path());
  if (!uri) {
    if (is_preflight_elsewhere(head))
      responder = std::make_shared<PreflightResponder>(std::move(responder), head);
    return other_.open(head, std::move(responder), std::move(flow));
  }

  const auto length = head.content_length();
  Sender sender;
  sender.address = head.peer();
  sender.began = ++uploads_->last;
  sender.bytes = static_cast<std::size_t>(length.value_or(0));
  UploadContext context{.message_handler = message_handler_,
                        .uri = *uri,
                        .sender = std::move(sender),
                        .responder = std::move(responder),
                        .uploads = uploads_};
  if (head.method() == "OPTIONS") {
    context.responder->answer(preflight_answer(allowed_methods(*uri), head));
    return nullptr;
  }
  if (const auto entry = check_entry(head); !entry) {
    context.refuse(entry.error());
    return nullptr;
  }
  if (!is_allowed(*uri, head.method())) {
    context.refuse({icd::Status::MethodNotAllowed, icd::sentence("method: expected ", icd::method_of(*uri))},
                   {{"Allow", allowed_methods(*uri)}});
    return nullptr;
  }
  auto sink = accept_upload(context, head, std::move(flow));
  if (sink) return *std::move(sink);
  context.refuse(sink.error());
  return nullptr;
}

icd::Checked<std::unique_ptr<BodySink>> IcdRoutes::accept_upload(UploadContext& context,
                                                                 const RequestHead& head,
                                                                 std::shared_ptr<FlowControl> flow) {
  codec::BodyKind kind;
  if (icd::method_of(context.uri) != "GET") kind = ADIT_TRY(read_head(context, head));
  switch (context.uri) {
    case icd::Uri::MapUpdate:
      return std::make_unique<MapUpload>(context,
                                         MapUploadOptions{.kind = kind,
                                                          .rules = options_.rules,
                                                          .most_bytes = most_bytes(context.uri),
                                                          .without_room = without_room_},
                                         std::move(flow), workers_, maps_);
    case icd::Uri::MarkersUpdate:
      return std::make_unique<MarkersUpload>(context, kind, options_.rules, workers_, markers_,
                                             large_markers_);
    case icd::Uri::ArtifactReports:
    case icd::Uri::StateUpdate:
      return std::make_unique<SmallUpload>(context, kind, options_.rules, small_);
    case icd::Uri::Status:
      return std::make_unique<StatusSink>(context);
  }
  return nullptr;
}

icd::Checked<codec::BodyKind> IcdRoutes::read_head(UploadContext& context, const RequestHead& head) const {
  const bool is_report = context.uri == icd::Uri::ArtifactReports;
  if (stopping_ && !is_report) return std::unexpected(stopping_refusal());
  const auto length = head.content_length();
  if (length == 0 && head.header("Content-Length").empty())  // RFC 9110 15.5.12
    return icd::refuse(icd::Status::LengthRequired, "Content-Length: missing, and no body came in chunks");
  const auto kind = ADIT_TRY(kind_of(context.uri, head));
  if (is_report) {
    const bool resubmits = ADIT_TRY(resubmits_of(head));
    context.sender.resubmits = resubmits;
  }
  const std::size_t most = most_bytes(context.uri);
  if (length && *length > most)
    return icd::refuse(icd::Status::ContentTooLarge, "Content-Length: expected at most ", most, ", got ",
                       *length);
  return kind;
}

void IcdRoutes::stop() {
  stopping_ = true;
  const std::set<Upload*> all = uploads_->under_way;
  for (Upload* upload : all) upload->reject(stopping_refusal());
}

}  // namespace adit::intake
