#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "intake/server.hpp"

namespace adit::api {

class BoxRoutes;
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

/// All handlers.
using Handlers = std::tuple<PageRoutes*, SessionRoutes*, RunRoutes*, MapRoutes*, ReportRoutes*, BoxRoutes*,
                            KeptRunsRoutes*, Clock*, Network*, SelfTest*, Setup*, Spare*, Updates*>;

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
  std::shared_ptr<intake::Flow> flow;            // for streamed bodies
  Asker asker;
  std::vector<std::string> parameters;  // of the path, in order
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

}  // namespace adit::api
