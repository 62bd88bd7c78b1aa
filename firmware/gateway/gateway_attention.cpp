// What the operator must know, in words.
#include <algorithm>
#include <iterator>

#include "gateway/gateway.hpp"
#include "icd/sentence.hpp"

namespace adit::gateway {

std::vector<std::string> Gateway::attention() const {
  std::vector<std::string> sentences = flow_.reports().attention();
  if (std::string change = network_.attention(); !change.empty()) {
    sentences.insert(sentences.begin(), std::move(change));  // it is the one that has a deadline
  }
  std::ranges::move(links_.attention(), std::back_inserter(sentences));
  if (!flow_.scoring().trouble().empty()) {
    sentences.push_back("no report is taken, the ledger cannot be written: " + flow_.scoring().trouble());
  }
  if (!flow_.maps().trouble().empty())
    sentences.push_back("the last map was not taken: " + flow_.maps().trouble());
  say_what_is_missing(sentences);
  if (!parts_.ledger.damage().empty()) sentences.push_back(parts_.ledger.damage());
  const auto token_refused = [&](const forward::Channel& channel, const char* name) {
    if (channel.last_status() == 401 && !channel.is_foreign()) {
      sentences.push_back(std::string("the Command Post refuses the ") + name + " token");
    }
  };
  const auto foreign = [&](const forward::Channel& channel, const char* name,
                           const settings::Address& address) {
    if (!channel.is_foreign()) return false;
    sentences.push_back(icd::sentence("what answers at ", forward::address_text(address),
                                      " is no Command Post (", name,
                                      "): nothing counts as taken there; is the address right?"));
    return true;
  };
  foreign(flow_.scoring().channel(), "scoring", settings_.command_post.scoring);
  if (!foreign(flow_.maps().channel(), "mapping", settings_.command_post.mapping)) {
    foreign(flow_.telemetry().channel(), "mapping", settings_.command_post.mapping);
  }
  say_what_is_set_aside(sentences);
  token_refused(flow_.scoring().channel(), "scoring");
  token_refused(
      flow_.maps().channel().last_status() == 401 ? flow_.maps().channel() : flow_.telemetry().channel(),
      "mapping");
  std::ranges::move(roster_.attention(loop_.now()), std::back_inserter(sentences));
  std::ranges::move(crowding_.attention(loop_.now()), std::back_inserter(sentences));
  const std::vector<std::string> refused = flow_.record().attention(loop_.stamp_now());
  sentences.insert(sentences.end(), refused.begin(), refused.end());
  if (flow_.maps().nearly_full() && refused.empty())
    sentences.emplace_back("the queue of maps is nearly full");
  return sentences;
}

/// Why the box should not be restarted just now, or "".
std::string Gateway::report_under_way() const {
  const dispatch::Reports& reports = flow_.reports();
  if (const auto* report = reports.sending())
    return icd::sentence("report ", report->number, " is being sent: its answer would have to be found out");
  const std::size_t waiting = reports.waiting_here().size();
  if (waiting == 0) return "";
  return icd::sentence(waiting, waiting == 1 ? " report waits" : " reports wait", " to be sent");
}

/// What the Command Post would not take, and is for the operator to look at.
void Gateway::say_what_is_set_aside(std::vector<std::string>& sentences) const {
  const auto rows = flow_.aside().rows();
  const auto count = std::ranges::count(rows, false, &api::AsideRow::overtaken);
  if (count == 0) return;
  sentences.push_back(icd::sentence(count, count == 1 ? " message is" : " messages are",
                                    " set aside: the Command Post would not take ",
                                    count == 1 ? "it" : "them"));
}

/// What was to be set up, and is not.
void Gateway::say_what_is_missing(std::vector<std::string>& sentences) const {
  for (const std::string* trouble : {&parts_.trouble, &parts_.loaded.trouble, &parts_.board_trouble}) {
    if (!trouble->empty()) sentences.push_back(*trouble);
  }
  std::ranges::copy(parts_.notices, std::back_inserter(sentences));
  if (!flow_.journal_trouble().empty()) {
    sentences.push_back("states and markers are not taken, they cannot be kept: " + flow_.journal_trouble());
  }
  if (!flow_.scoring().channel().has_token())
    sentences.emplace_back("no scoring token is set: reports wait until one is");
  if (!flow_.maps().channel().has_token()) {
    sentences.emplace_back("no mapping token is set: maps, states and markers wait until one is");
  }
  if (settings_.team.require_token && parts_.loaded.secrets.tokens.empty()) {
    sentences.emplace_back("no token is set at all: every robot is turned away");
  }
}

}  // namespace adit::gateway
