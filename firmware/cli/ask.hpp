#pragma once

#include <chrono>
#include <expected>
#include <functional>
#include <string>

#include "api/run_view.hpp"
#include "cli/http_client.hpp"
#include "cli/options.hpp"
#include "cli/outcome.hpp"
#include "settings/settings.hpp"

namespace adit::cli {

inline constexpr std::chrono::milliseconds kReadPatience{3000};

/// The Adit that the options mean: where it is, and what it is asked with.
struct Adit {
  settings::Address address;
  Token token;
};

/// Without a token, the sentence says how to name one.
std::expected<Adit, std::string> adit_of(const Options& options);

/// The body of a 200, or a sentence.
std::expected<std::string, std::string> get(const Adit& adit, const std::string& target);

/// What the page shows of the run: GET /adit/run. A sentence if Adit does not answer or its answer cannot be
/// read.
std::expected<api::RunView, std::string> run_view(const Adit& adit);

/// An action that was not done, or of which that is not known.
struct Failure {
  Exit exit = Exit::Unable;  // Attention: Adit rejected the action
  std::string sentence;
};

/// The body of an action's 200. `body`: JSON, or nothing. `check`: the command that tells whether an action
/// was done whose answer was lost.
std::expected<std::string, Failure> post(const Adit& adit, const std::string& target, const std::string& body,
                                         const std::string& check);

/// The body of a 200, where the answer may be that there is no such thing.
std::expected<std::string, Failure> find(const Adit& adit, const std::string& target,
                                         std::chrono::milliseconds within = kReadPatience);

/// For an answer that is not 200.
Failure failure(const Adit& adit, const HttpReply& reply);

/// Whether `is_over` became true within so long. It is called at once, and then again after each `every`.
bool wait_for(std::chrono::milliseconds within, std::chrono::milliseconds every,
              const std::function<bool()>& is_over);

/// The sentence that an error's body is (a JSON string); "" where it is none.
std::string sentence_in(const std::string& body);

/// `why` on standard error.
Outcome unable(const std::string& why);
Outcome unable(const Failure& failure);

/// `adit status`: asks the running Adit and shows its answer.
Outcome status(const Options& options, bool colour);

}  // namespace adit::cli
