#include "intake/visit.hpp"

#include <algorithm>

#include "icd/sentence.hpp"
#include "intake/answer.hpp"
#include "intake/head.hpp"
#include "intake/icd_routes.hpp"
#include "intake/upload.hpp"

namespace adit::intake {
namespace {

constexpr std::string_view kHeadersOfClients = "authorization, content-type, content-encoding";
constexpr std::size_t kLongestHeaderList = 512;

class CorsResponder final : public PassingResponder {
 public:
  using PassingResponder::PassingResponder;
  void answer(Answer answer) override {
    answer.headers.push_back({"Access-Control-Allow-Origin", "*"});
    inner().answer(std::move(answer));
  }
};

/// Field names (RFC 9110 5.6.2 tokens) with commas and blanks between them.
bool is_token_list(std::string_view text) {
  return !text.empty() && text.size() <= kLongestHeaderList && std::ranges::all_of(text, [](char letter) {
    return is_token_letter(letter) || letter == ',' || kBlanks.contains(letter);
  });
}

}  // namespace

Sender Visit::sender_at_end() const {
  Sender whole = sender;
  whole.ended = ++uploads->last;
  for (const Upload* other : uploads->under_way) {
    const bool is_other = other->is_like(*this) && other->began() != sender.began;
    if (is_other && (whole.overlaps == 0 || other->began() < whole.overlaps)) whole.overlaps = other->began();
  }
  return whole;
}

void Visit::refuse(const icd::Refusal& refusal, std::vector<Header> headers) const {
  Answer answer = error_answer(refusal.status, refusal.sentence);
  answer.headers = std::move(headers);
  responder->answer(std::move(answer));
  desk.refused(uri, sender, refusal);
}

void Visit::answer(const icd::Checked<void>& taken) const {
  if (!taken) {
    refuse(taken.error());
  } else {
    responder->answer({.body = "null", .headers = {}});
  }
}

std::shared_ptr<Responder> with_cors(std::shared_ptr<Responder> responder) {
  return std::make_shared<CorsResponder>(std::move(responder));
}

bool is_allowed(icd::Uri uri, std::string_view method) {
  return method == icd::method_of(uri) || (method == "HEAD" && icd::method_of(uri) == "GET");
}

std::string allowed_methods(icd::Uri uri) {
  return icd::sentence(icd::method_of(uri), is_allowed(uri, "HEAD") ? ", HEAD" : "", ", OPTIONS");
}

Answer preflight_answer(icd::Uri uri, std::string_view asked_headers) {
  const std::string_view headers = is_token_list(asked_headers) ? asked_headers : kHeadersOfClients;
  return {.status = icd::Status::NoContent,
          .body = {},
          .headers = {{"Access-Control-Allow-Methods", allowed_methods(uri)},
                      {"Access-Control-Allow-Headers", std::string(headers)},
                      {"Access-Control-Max-Age", "86400"}}};
}

}  // namespace adit::intake
