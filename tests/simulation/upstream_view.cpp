#include "simulation/upstream_view.hpp"

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "simulation/icd_reading.hpp"
#include "simulation/messages.hpp"
#include "simulation/world.hpp"

namespace adit::simulation {
namespace {

constexpr std::size_t kLongestBody = 64u << 10;  // bytes of an answer's body

/// Neither JSON nor empty.
bool is_page(const std::string& body) {
  return !body.empty() && !nlohmann::json::accept(body);
}

}  // namespace

void UpstreamView::left(std::string_view bytes) {
  World& world = World::current();
  if (requests_.is_between()) {
    const std::size_t from = bytes.find(' ') + 1;
    const std::string target(bytes.substr(from, bytes.find(' ', from) - from));
    path_ = without_slash(target);
    world.note({.kind = Kind::Leaves,
                .what = path_,
                .who = "",
                .status = target == path_ ? 0 : kWithSlash,
                .request = connection_});
  }
  requests_.feed(bytes);
  while (const auto request = requests_.next()) {
    world.note({.kind = Kind::Complete, .what = path_, .who = ""});
    if (const std::string fault = fault_of(*request); !fault.empty()) {
      world.note({.kind = Kind::Forbidden, .what = path_, .who = "", .text = fault});
      continue;
    }
    for (const Item& item : items_of(*request)) {
      world.note({.kind = Kind::Left,
                  .what = path_,
                  .who = item.who,
                  .serial = item.serial,
                  .stamp = item.stamp,
                  .request = connection_,
                  .says = item.says});
    }
  }
}

void UpstreamView::came(std::string_view bytes) {
  answers_.feed(bytes);
  while (const auto answer = answers_.next()) {
    if (answer->status() < 200) continue;
    World::current().note({.kind = Kind::Replied,
                           .what = path_,
                           .who = is_page(answer->body) ? kForeign : "",
                           .serial = place_,
                           .status = answer->status(),
                           .stamp = std::atof(answer->header("retry-after").c_str()),
                           .text = path_ == kStatus ? answer->body : "",
                           .request = connection_,
                           .says = path_ == kStatus    ? status_in(answer->body)
                                   : path_ == kReports ? reply_in(answer->body)
                                                       : Says()});
  }
  if (!answers_.head() || answers_.length() <= kLongestBody) return;
  World::current().note({.kind = Kind::Replied,
                         .what = path_,
                         .who = kTooLong,
                         .status = answers_.head()->status(),
                         .request = connection_});
}

}  // namespace adit::simulation
