#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "api/answers.hpp"
#include "codec/field.hpp"
#include "codec/json.hpp"
#include "icd/sentence.hpp"
#include "icd/text.hpp"
#include "intake/server.hpp"

namespace adit::api {

class BoxRoutes;
class Certificate;
class Clock;
class KeptRunsRoutes;
class MapRoutes;
class Network;
class PageRoutes;
class ReportRoutes;
class RunRoutes;
class SelfTest;
class SessionRoutes;
class Setup;
class Spare;
class Updates;

using Handlers =
    std::tuple<PageRoutes*, SessionRoutes*, RunRoutes*, MapRoutes*, ReportRoutes*, BoxRoutes*,
               KeptRunsRoutes*, Certificate*, Clock*, Network*, SelfTest*, Setup*, Spare*, Updates*>;

/// Clients that may use a route. A script with a token is an operator.
enum class RouteAccess : std::uint8_t {
  Open,             // any client from any page: holds no data of the team
  OwnPage,          // any client, but not from another site's page
  OperatorOrSetUp,  // an operator; at the first start, and while set-up is open, as OwnPage
  Viewer,           // any logged-in user
  Operator,
};

/// A route's request body.
struct Body {
  std::string_view type;     // Content-Type; "": none, and a body is discarded
  std::size_t most = 0;      // bytes
  bool as_it_comes = false;  // streamed to Handle::begin; otherwise the handler gets the whole body
};

/// The client.
struct Asker {
  bool admitted = false;      // has the role that the route requires
  std::uint64_t session = 0;  // 0: none
};

/// An admitted request.
struct Call {
  const intake::RequestHead& head;
  std::shared_ptr<intake::Responder> responder;  // for late answers
  std::shared_ptr<intake::FlowControl> flow;     // for streamed bodies
  Asker asker;
  std::vector<std::string> parameters;  // of the path, in order
  SharedRedaction redaction;            // is applied to the answer, but not to a file that it packs
  std::string body;
};

/// A function on one of the Handlers. Exactly one pointer is set.
struct Handle {
  intake::Answer (*answer)(const Handlers& handlers, const Call& call) = nullptr;
  /// Answers by Call::responder, at once or later.
  void (*answer_later)(const Handlers& handlers, const Call& call) = nullptr;
  /// Returns a receiver of the body, which answers. Null: it has answered.
  std::unique_ptr<intake::BodySink> (*begin)(const Handlers& handlers, const Call& call) = nullptr;
};

/// A row of the table of routes.
struct Route {
  std::string_view method;  // GET includes HEAD
  std::string_view path;  // "/adit/reports/{number}/send"; a parameter has at least one character and no '/'
  RouteAccess who = RouteAccess::Operator;
  Body body;
  Handle handle;
};

/// The table of all routes. README.md describes them, /adit/openapi.json describes them for programs. The
/// page's files are not in it and are open to all.
std::span<const Route> routes();

/// A request's place in the table.
struct Match {
  const Route* route = nullptr;             // null: no such path or method
  std::vector<std::string> parameters;      // of the path, in order
  std::string allowed;                      // methods of the path (RFC 9110 10.2.1): "GET, HEAD"; "": no such
                                            // path
  RouteAccess who = RouteAccess::Operator;  // clients that may use it, or learn that there is no route
};
Match match(const intake::RequestHead& head);

/// A number in the query, if present. `expected`: the sentence of the refusal if it is not a finite number.
inline icd::Checked<std::optional<double>> asked_number(const intake::RequestHead& head,
                                                        std::string_view name, std::string_view expected) {
  const std::string_view text = head.query(name);
  if (text.empty()) return std::nullopt;
  const auto number = icd::number_in<double>(text);
  if (!number || !std::isfinite(*number)) return icd::refuse(icd::Status::BadRequest, expected);
  return number;
}

/// Applies `read` to a body, which must be one JSON object.
template <class Message, class Read>
icd::Checked<Message> read_body(const std::string& body, Read read) {
  const auto root = codec::parse_json(body);
  if (!root) return icd::refuse(icd::Status::BadRequest, "expected JSON: ", root.error());
  codec::Reading reading;
  return reading.outcome<Message>(read(codec::Field(*root, reading)));
}

/// The text of the member `name` of a body.
inline icd::Checked<std::string> read_text(const std::string& body, std::string_view name) {
  return read_body<std::string>(
      body, [name](const codec::Field& root) { return std::string(root.member(name).text()); });
}

/// Collects a body of at most `most` bytes and passes it to `done` when complete.
class SmallBody final : public intake::BodySink {
 public:
  SmallBody(std::shared_ptr<intake::Responder> responder, std::size_t most,
            std::function<void(std::string body)> done)
      : responder_(std::move(responder)), most_(most), done_(std::move(done)) {}

  static intake::Answer too_long(std::size_t most, std::string_view what = "body") {
    return refusal(icd::Status::ContentTooLarge,
                   icd::sentence("expected a ", what, " of at most ", most, " bytes"));
  }

  bool on_body(std::span<const std::uint8_t> piece) override {
    if (refused_) return true;
    if (body_.size() + piece.size() > most_) {
      refused_ = true;
      responder_->answer(too_long(most_));
    } else {
      body_.append(reinterpret_cast<const char*>(piece.data()), piece.size());
    }
    return true;
  }
  void on_end() override {
    if (!refused_) done_(std::move(body_));
  }

 private:
  std::shared_ptr<intake::Responder> responder_;
  std::size_t most_;
  std::function<void(std::string)> done_;
  std::string body_;
  bool refused_ = false;
};

}  // namespace adit::api
