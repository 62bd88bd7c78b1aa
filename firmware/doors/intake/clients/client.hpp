/// A client that retries until the outcome is known. `bare`: it posts to a Command Post without Adit.
#pragma once

#include <curl/curl.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

/// The message was rejected; the same message would be rejected again.
struct Refused : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The report may have been recorded; a person must decide what to do.
struct Unknown : std::runtime_error {
  using std::runtime_error::runtime_error;
};

class Client {
  using json = nlohmann::json;
  using clock = std::chrono::steady_clock;
  static constexpr long kNeverLeft = -1, kLost = 0;  // instead of a status

 public:
  Client(std::string url, std::string token, bool bare)
      : url_(std::move(url)), token_(std::move(token)), bare_(bare) {}

  json status() { return until_answered("/api/status"); }

  /// The Command Post's answer.
  json report(double x, double y, double z, const std::string& type) {
    const json message = {{"x", x}, {"y", y}, {"z", z}, {"type", type}};
    return until_answered("/api/artifact_reports", message.dump(), "application/json");
  }

  /// Sends a map, a state or markers, as CBOR: update("map", ...).
  json update(const std::string& what, const json& message) {
    const auto body = json::to_cbor(message);
    return until_answered("/" + what + "/update", {body.begin(), body.end()}, "application/cbor");
  }

 private:
  struct Answer {
    long status = kLost;
    std::string body = {};
    curl_off_t again_after = 0;  // seconds; 0: not given
  };

  /// Returns the body of a 2xx. Retries for ten minutes if a retry is safe.
  json until_answered(const std::string& uri, const std::string& body = "", const std::string& type = "") {
    for (const auto end = clock::now() + std::chrono::minutes(10); clock::now() < end;) {
      const Answer answer = ask(uri, body, type);
      const long status = answer.status;
      if (status / 100 == 2) return json::parse(answer.body);
      if (status == kLost || status == 408 || status >= 500) {  // Adit recognises a retried report
        if (bare_ && uri == "/api/artifact_reports")
          throw Unknown("no answer: see whether remaining_reports went down before you post it again");
      } else if (status == 409) {
        throw Unknown(answer.body);
      } else if (status != kNeverLeft && status != 429) {
        throw Refused(std::to_string(status) + " " + answer.body);
      }
      std::this_thread::sleep_for(std::chrono::seconds(std::max<curl_off_t>(answer.again_after, 1)));
    }
    throw Unknown("no answer for ten minutes");
  }

  /// Sends one request on a new connection, because a bare Command Post closes old ones without notice. Waits
  /// 3 s for the connection and 30 s in all, because Adit answers within 20 s.
  Answer ask(const std::string& uri, const std::string& body, const std::string& type) {
    if (bare_) std::this_thread::sleep_until(turn_);  // it accepts one request a second
    Answer answer;
    CURL* const curl = curl_easy_init();
    curl_slist* headers = curl_slist_append(nullptr, ("Authorization: Bearer " + token_).c_str());
    headers = curl_slist_append(headers, ("Content-Type: " + type).c_str());
    headers = curl_slist_append(headers, "Expect:");  // a bare Command Post never answers Expect
    curl_easy_setopt(curl, CURLOPT_URL, (url_ + uri).c_str());
    curl_easy_setopt(curl, CURLOPT_PROXY, "");  // not http_proxy
    curl_easy_setopt(curl, CURLOPT_HTTPHEADER, headers);
    curl_easy_setopt(curl, CURLOPT_CONNECTTIMEOUT, 3L);
    curl_easy_setopt(curl, CURLOPT_TIMEOUT, 30L);
    curl_easy_setopt(curl, CURLOPT_WRITEFUNCTION, append);
    curl_easy_setopt(curl, CURLOPT_WRITEDATA, &answer.body);
    if (!body.empty()) {  // otherwise a GET
      curl_easy_setopt(curl, CURLOPT_POSTFIELDSIZE, static_cast<long>(body.size()));
      curl_easy_setopt(curl, CURLOPT_POSTFIELDS, body.data());
    }
    long status = 0, sent = 0;
    const bool whole = curl_easy_perform(curl) == CURLE_OK;
    curl_easy_getinfo(curl, CURLINFO_REQUEST_SIZE, &sent);
    curl_easy_getinfo(curl, CURLINFO_RESPONSE_CODE, &status);
    curl_easy_getinfo(curl, CURLINFO_RETRY_AFTER, &answer.again_after);
    if (sent == 0) answer.status = kNeverLeft;
    // Half an answer does not count. A redirection or a 2xx without JSON comes from another machine.
    if (whole && (status >= 400 || (status / 100 == 2 && json::accept(answer.body)))) answer.status = status;
    curl_slist_free_all(headers);
    curl_easy_cleanup(curl);
    turn_ = clock::now() + std::chrono::milliseconds(1100);
    return answer;
  }

  static std::size_t append(const char* data, std::size_t, std::size_t size, void* body) {
    static_cast<std::string*>(body)->append(data, size);
    return size;
  }

  const std::string url_, token_;
  const bool bare_;
  clock::time_point turn_{};
};
