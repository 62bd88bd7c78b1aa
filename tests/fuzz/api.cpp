// What the page and scripts ask: a line with method and target, and after it the body, by the table of
// routes, as an operator.
#include <algorithm>

#include "api/on_page.hpp"
#include "api/route.hpp"
#include "codec/json.hpp"
#include "codec/utf8.hpp"
#include "target.hpp"

namespace adit::fuzz {
namespace {

struct Question {
  std::string method, target, body;
};

/// A page with something to tell.
struct Played : api::Page {
  Played() {
    source.details[1].row.number = 1;
    updates.view.managed = network.view.managed = true;
  }
  /// What an answer may have changed.
  auto state() {
    return std::tuple(decisions.decided, decisions.reported.size(), decisions.decided_messages.size(),
                      decisions.run, decisions.identified, setup.saves, setup.set, setup.resets,
                      keys.operator_, keys.viewer, keys.sessions().all(loop.now()).size(),
                      network.wanted.size(), network.confirmed, network.reverted, test.view.running,
                      updates.sticks, updates.restarts);
  }
};

std::string_view content_type(const Question& question) {
  const std::string_view path = std::string_view(question.target).substr(0, question.target.find('?'));
  const auto route = std::ranges::find_if(api::routes(), [&](const api::Route& each) {
    return each.path == path && each.method == question.method;
  });
  return route == api::routes().end() ? "application/json" : route->body.type;
}

/// The answer; nothing where it is a stream, or hangs on what is still to come.
std::optional<intake::Answer> ask(Played& page, const Question& question, std::size_t piece) {
  const auto sink =
      page.open(question.method, question.target,
                {api::kByToken, {"Content-Type", std::string(content_type(question))}}, question.body.size());
  if (sink) {
    in_pieces(question.body, piece, [&](Input each) { return sink->on_body(bytes_of(each)); });
    sink->on_end();
  }
  if (page.updates.received.done) page.updates.received.done({});
  return page.responder->answered;
}

/// A refusal says why in a sentence, which names what is wrong with the body, and nothing was done.
void require_refusal(const intake::Answer& answer) {
  const auto said = codec::parse_json(answer.body);
  require(said.has_value() && std::holds_alternative<std::string>(said->is));
  const auto& sentence = std::get<std::string>(said->is);
  require(!sentence.empty());
  if (answer.status == icd::Status::UnprocessableEntity) require(sentence.contains(": "));
}

void require_answer(const intake::Answer& answer, bool is_same) {
  const int status = static_cast<int>(answer.status);
  require(status >= 200 && status < 500);
  if (status >= 400) {
    require_refusal(answer);
    require(is_same);
  } else if (answer.content_type == "application/json" && !answer.body.empty()) {
    require(codec::parse_json(answer.body).has_value());
  }
}

}  // namespace

void try_api(Input text) {
  const std::size_t piece = take_piece(text);
  const Input line = text.substr(0, text.find('\n'));
  const std::size_t blank = line.find(' ');
  if (blank == Input::npos || !codec::is_utf8(line)) return;  // intake lets no other in
  const Question question{.method = std::string(line.substr(0, blank)),
                          .target = std::string(line.substr(blank + 1)),
                          .body = std::string(text.substr(std::min(line.size() + 1, text.size())))};
  Played whole, cut;
  const auto before = whole.state();
  const auto answer = ask(whole, question, std::max<std::size_t>(question.body.size(), 1));
  const auto other = ask(cut, question, piece);
  require(answer.has_value() == other.has_value());
  require(whole.state() == cut.state());
  if (!answer) return require(whole.responder->streaming != nullptr);
  require(answer->status == other->status);
  require_answer(*answer, whole.state() == before);
}

}  // namespace adit::fuzz
