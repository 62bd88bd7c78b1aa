// An answer of the Command Post, or of whoever answers in its place.
#include "codec/read.hpp"
#include "codec/row.hpp"
#include "dispatch/verdicts.hpp"
#include "target.hpp"
#include "uplink/exchange.hpp"

namespace adit::fuzz {
namespace {

using uplink::AnswerParser;
using State = AnswerParser::State;

constexpr std::size_t kLongestBody = 4096, kLongestText = 300;

struct ReadAnswer {
  AnswerParser parser{kLongestBody};
  State state = State::Incomplete;
};

void read_answer(ReadAnswer& answer, Input text, std::size_t piece) {
  in_pieces(text, piece, [&answer](Input each) {
    answer.state = answer.parser.feed(each);
    return answer.state == State::Incomplete;
  });
  if (answer.state == State::Incomplete) answer.state = answer.parser.feed_end();
}

/// What is no Command Post's answer counts as nothing taken and nothing recorded.
void judge_body(int status, std::string_view text) {
  const auto body = dispatch::body_of(text);
  require(!text.empty() || body == dispatch::Body::Empty);
  if (body == dispatch::Body::Other) {
    require(dispatch::mapping_verdict(status, body) != dispatch::MappingVerdict::Taken);
    const auto reply = codec::read_report_reply(text);
    require(!reply && !reply.error().empty());
    require(dispatch::event_of(status, false, body) != dispatch::ReportEvent::Recorded);
  }
  require(dispatch::answer_text(status, text).size() <= kLongestText);
  settles(text, codec::read_run_status, codec::to_json<icd::RunStatus>);
}

}  // namespace

void try_answer(Input text) {
  const std::size_t piece = take_piece(text);
  ReadAnswer at_once, cut;
  read_answer(at_once, text, text.size() + 1);
  read_answer(cut, text, piece);
  require(at_once.state == cut.state && at_once.state != State::Incomplete);
  if (at_once.state == State::Malformed) {
    require(!at_once.parser.fault().empty() && !cut.parser.fault().empty());
    require(at_once.parser.too_long_status() == cut.parser.too_long_status());
    return;
  }
  const uplink::Answered answered = at_once.parser.take_answer(), same = cut.parser.take_answer();
  require(answered.status == same.status && answered.body == same.body);
  require(answered.content_type == same.content_type && answered.retry_after == same.retry_after);
  require(answered.date == same.date);
  require(answered.status >= 200 && answered.status < 600 && answered.body.size() <= kLongestBody);
  judge_body(answered.status, answered.body);
}

}  // namespace adit::fuzz
