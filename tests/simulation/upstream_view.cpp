#include "simulation/upstream_view.hpp"

#include <cstdlib>
#include <ctime>
#include <nlohmann/json.hpp>

#include "simulation/bytes.hpp"
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

bool is_to_other_form(const HttpMessage& answer, const std::string& path) {
  const std::string location = answer.header("location");
  return answer.status() / 100 == 3 && (location == path || location == path + "/");
}

/// Seconds that the answer asks for, by its Retry-After.
double pause_in(const HttpMessage& answer) {
  const auto time = [&answer](const char* field) {
    std::tm parts{};
    const char* const end = strptime(answer.header(field).c_str(), "%a, %d %b %Y %H:%M:%S GMT", &parts);
    return end == nullptr ? 0.0 : static_cast<double>(timegm(&parts));
  };
  const double until = time("retry-after");
  return until > 0 ? until - time("date") : std::atof(answer.header("retry-after").c_str());
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
    const bool is_gzip = answer->header("content-encoding") == "gzip";
    const std::string body = is_gzip ? inflated(answer->body) : answer->body;
    World::current().note({.kind = Kind::Replied,
                           .what = path_,
                           .who = is_to_other_form(*answer, path_) ? kOtherForm
                                  : is_page(body)                  ? kForeign
                                                                   : "",
                           .serial = place_,
                           .status = answer->status(),
                           .stamp = pause_in(*answer),
                           .text = path_ == kStatus ? body : "",
                           .request = connection_,
                           .says = path_ == kStatus    ? status_in(body)
                                   : path_ == kReports ? reply_in(body)
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
