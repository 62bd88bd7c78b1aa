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
class ClockRoutes;
class KeptRunsRoutes;
class MapRoutes;
class NetworkRoutes;
class PageRoutes;
class ReportRoutes;
class RunRoutes;
class SessionRoutes;
class SettingsRoutes;
class SpareRoutes;
class UpdateRoutes;

/// What answers.
using Handlers =
    std::tuple<PageRoutes*, SessionRoutes*, RunRoutes*, MapRoutes*, ReportRoutes*, SettingsRoutes*,
               NetworkRoutes*, UpdateRoutes*, BoxRoutes*, KeptRunsRoutes*, ClockRoutes*, SpareRoutes*>;

/// Who may use a route. A script that sends one of the tokens is an operator.
enum class Who : std::uint8_t {
  Open,             // anybody, from anywhere: nothing of the team's is in it
  OwnPage,          // anybody, but no page from elsewhere
  OperatorOrSetUp,  // an operator; at the first start, and while set-up is open, as OwnPage
  Viewer,           // whoever is logged in
  Operator,
};

/// The body that a route asks for.
struct Body {
  std::string_view type;     // Content-Type; "": none, and what comes is read away
  std::size_t most = 0;      // bytes
  bool as_it_comes = false;  // to Handle::begin; else the handler is called once it is whole
};

/// Who asks.
struct Asker {
  bool admitted = false;      // he has the role that the route asks for
  std::uint64_t session = 0;  // 0: none
};

/// A request that its route lets through.
struct Call {
  const intake::RequestHead& head;
  std::shared_ptr<intake::Responder> responder;  // for what answers later
  std::shared_ptr<intake::Flow> flow;            // for what takes the body as it comes
  Asker asker;
  std::vector<std::string> parameters;  // of the path, in its order
  std::string body;
};

/// A member of one of the Handlers, of one of three kinds; the others are null.
struct Handle {
  intake::Answer (*answer)(const Handlers& handlers, const Call& call) = nullptr;
  /// Answers by Call::responder, at once or later.
  void (*answer_later)(const Handlers& handlers, const Call& call) = nullptr;
  /// Gives what takes the body as it comes and answers; null: it has answered.
  std::unique_ptr<intake::BodySink> (*begin)(const Handlers& handlers, const Call& call) = nullptr;
};

/// A row of the table of routes.
struct Route {
  std::string_view method;  // HEAD goes with GET
  std::string_view path;  // "/adit/reports/{number}/send": a parameter is of at least one letter, without '/'
  Who who = Who::Operator;
  Body body;
  Handle handle;
};

}  // namespace adit::api
