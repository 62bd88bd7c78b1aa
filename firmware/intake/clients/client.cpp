#include "client.hpp"

#include <curl/curl.h>

#include <algorithm>
#include <thread>
#include <utility>

using nlohmann::json;
using std::chrono::steady_clock;

namespace {
const std::string kReports = "/api/artifact_reports";
constexpr std::chrono::minutes kPatience(10);

std::size_t append(const char* data, std::size_t, std::size_t size, void* body) {
  static_cast<std::string*>(body)->append(data, size);
  return size;
}
}  // namespace

Client::Client(std::string url, std::string token, bool bare)
    : url_(std::move(url)), token_(std::move(token)), bare_(bare) {}

json Client::status() {
  return until_answered({"/api/status", "", ""});
}

json Client::report(double x, double y, double z, const std::string& type) {
  const json message = {{"x", x}, {"y", y}, {"z", z}, {"type", type}};
  return until_answered({kReports, message.dump(), "application/json"});
}

json Client::update(const std::string& what, const json& message) {
  const auto body = json::to_cbor(message);
  return until_answered({"/" + what + "/update", {body.begin(), body.end()}, "application/cbor"});
}

/// What a 2xx says. Sends the same again, as long as that can do no harm.
json Client::until_answered(const Request& request) {
  const auto end = steady_clock::now() + kPatience;
  while (steady_clock::now() < end) {
    const Answer answer = ask(request);
    const long status = answer.status;
    if (status / 100 == 2) return json::parse(answer.body);
    if (status == 409) throw Unknown(answer.body);
    if (status == 0 || status == 408 || status >= 500) {  // Adit knows a report that is posted again
      if (bare_ && request.uri == kReports && !answer.never_left)
        throw Unknown("no answer: see whether remaining_reports went down before you post it again");
    } else if (status != 429) {
      throw Refused(std::to_string(status) + " " + answer.body);
    }
    std::this_thread::sleep_for(std::chrono::seconds(answer.again_after));
  }
  throw Unknown("no answer for ten minutes");
}

/// One request, 3 s to connect, 30 s in all: Adit answers within 20.
Client::Answer Client::ask(const Request& request) {
  if (bare_) std::this_thread::sleep_until(turn_);  // it takes one request a second
  Answer answer;
  CURL* const curl =
      curl_easy_init();  // a new connection: a bare Command Post closes old ones without a word
  curl_slist* headers = curl_slist_append(nullptr, ("Authorization: Bearer " + token_).c_str());
  headers = curl_slist_append(headers, ("Content-Type: " + request.type).c_str());
  headers = curl_slist_append(headers, "Expect:");  // which a bare Command Post never answers
  curl_easy_setopt(curl, CURLOPT_URL, (url_ + request.uri).c_str());
  curl_easy_setopt(curl, CURLOPT_HTTPHEADER, headers);
  curl_easy_setopt(curl, CURLOPT_CONNECTTIMEOUT, 3L);
  curl_easy_setopt(curl, CURLOPT_TIMEOUT, 30L);
  curl_easy_setopt(curl, CURLOPT_WRITEFUNCTION, append);
  curl_easy_setopt(curl, CURLOPT_WRITEDATA, &answer.body);
  if (!request.body.empty()) {
    curl_easy_setopt(curl, CURLOPT_POSTFIELDSIZE, static_cast<long>(request.body.size()));
    curl_easy_setopt(curl, CURLOPT_POSTFIELDS, request.body.data());
  }
  if (curl_easy_perform(curl) == CURLE_OK) {
    curl_off_t again_after = 0;
    curl_easy_getinfo(curl, CURLINFO_RESPONSE_CODE, &answer.status);
    curl_easy_getinfo(curl, CURLINFO_RETRY_AFTER, &again_after);
    answer.again_after = std::max<long>(again_after, 1);
    if (answer.status / 100 == 2 && !json::accept(answer.body)) answer.status = 0;  // no answer of theirs
  } else {
    long sent = 0;
    curl_easy_getinfo(curl, CURLINFO_REQUEST_SIZE, &sent);
    answer.never_left = sent == 0;
  }
  curl_slist_free_all(headers);
  curl_easy_cleanup(curl);
  turn_ = steady_clock::now() + std::chrono::milliseconds(1100);
  return answer;
}
