#include "dispatch/doubts.hpp"

#include <algorithm>

#include "codec/write.hpp"
#include "dispatch/reconciled_answer.hpp"
#include "dispatch/report_verdict.hpp"
#include "icd/sentence.hpp"

namespace adit::dispatch {
namespace {

/// Empty if the run's status can decide a group that begins with this report.
std::string undecidable_first(const Report& report, const Run& run, const Run* its) {
  if (its != nullptr && !its->post.empty() && its->post != run.post) {
    return "it was sent to the Command Post at " + its->post +
           ", which Adit asks again when the settings name it again";
  }
  if (report.run != run.number) return "a new run began before the status showed whether it was recorded";
  if (!run.unreliable.empty()) return run.unreliable;
  if (!report.before && report.sent < run.began) {
    return "a new run began just after it was sent, so that it may have been recorded in either run";
  }
  if (!report.before) {
    return report.uncertain.empty() ? "the Command Post's counts before it was sent are not certain"
                                    : report.uncertain;
  }
  return "";
}

SentSince sent_since(const Report& doubt, const ReportBook& book) {
  SentSince since;
  for (const auto& [number, report] : book.all()) {
    if (report.run != doubt.run || report.sending <= doubt.sending) continue;
    const Effect effect = effect_of(report);
    since.scored += effect.scored ? 1 : 0;
    since.points += effect.points.value_or(0);
    since.unclear += effect.points ? 0 : 1;
  }
  return since;
}

constexpr const char* kOperator = "; the operator decides: send it, or settle it";

}  // namespace

std::vector<Doubts::Reports> Doubts::groups() const {
  std::vector<Reports> groups;
  for (const Report* const doubt : all()) {
    if (doubt->before) groups.emplace_back();
    if (!groups.empty()) groups.back().push_back(doubt);
  }
  return groups;
}

const Report* Doubts::leader_of(const Report& doubt) const {
  for (const Reports& group : groups()) {
    if (std::ranges::find(group, doubt.number, &Report::number) != group.end()) return group.front();
  }
  return &doubt;
}

std::string Doubts::undecidable(const Report& doubt) const {
  const Report& first = *leader_of(doubt);
  return undecidable_first(first, account_.run(), account_.runs().find(first.run));
}

bool Doubts::has_open_group() const {
  return std::ranges::any_of(groups(), [](const Reports& group) {
    return std::ranges::any_of(group, [](const Report* doubt) { return !doubt->counted; });
  });
}

std::int64_t Doubts::open_count() const {
  std::int64_t open = 0;
  for (const Report* const doubt : all()) {
    if (doubt->before) break;
    open += doubt->counted ? 0 : 1;
  }
  return open;
}

bool Doubts::is_asking(const Report& report) const {
  if (report.state != ReportState::InDoubt || report.run != account_.run().number) return false;
  const auto inquiry = inquiries_.find(leader_of(report)->number);
  return inquiry != inquiries_.end() && !inquiry->second.is_in_vain();
}

bool Doubts::is_pending(Instant now) const {
  return std::ranges::any_of(inquiries_, [now](const auto& each) { return each.second.is_pending(now); });
}

std::optional<Instant> Doubts::next_ask(Instant now) const {
  std::optional<Instant> first;
  for (const auto& [number, inquiry] : inquiries_) {
    first = std::min(first.value_or(inquiry.next_ask(now)), inquiry.next_ask(now));
  }
  return first;
}

void Doubts::open() {
  std::vector<Report> changed;
  std::int64_t others = 0;
  bool has_group = false, is_open = false;
  for (const Report* const doubt : all()) {
    if (doubt->before && (is_open || doubt->beside < others)) {
      Report& report = changed.emplace_back(*doubt);
      if (is_open) report.before.reset();
      report.beside = std::max(report.beside, others);
    }
    has_group = has_group || doubt->before.has_value();
    if (doubt->counted) continue;
    is_open = has_group;
    if (!has_group) ++others;
  }
  if (!changed.empty()) book_.change(changed, account_.run());
}

void Doubts::begin(Instant now) {
  inquiries_.clear();
  for (const Report* const doubt : all()) lost_.try_emplace(doubt->number, now);
  for (const Reports& group : groups()) {
    if (undecidable(*group.front()).empty()) inquiries_.emplace(group.front()->number, Inquiry(policy_, now));
  }
}

void Doubts::lost(std::int64_t number, Instant now) {
  lost_[number] = now;
  account_.lose();
  begin(now);
}

void Doubts::failed(Time time) {
  for (const Reports& group : groups()) {
    const auto found = inquiries_.find(group.front()->number);
    if (found == inquiries_.end()) continue;
    Inquiry& inquiry = found->second;
    inquiry.asked(time.now);
    inquiry.failed(time.now);
    if (inquiry.is_in_vain()) {
      explain(group, "the Command Post does not answer with the run's status", time);
    }
  }
}

/// Later doubts may explain a change, too.
Evidence Doubts::weigh_group(const Reports& group, const icd::RunStatus& status) const {
  const Report& first = *group.front();
  const auto later = std::ranges::count_if(
      all(), [&](const Report* doubt) { return doubt->sending > group.back()->sending; });
  return weigh(*first.before, std::ssize(group), first.beside + later, sent_since(first, book_), status);
}

std::vector<ReportBook::Step> Doubts::hear(const icd::RunStatus& status, Instant asked, Time time) {
  std::vector<ReportBook::Step> steps;
  for (const Reports& group : groups()) {
    const auto found = inquiries_.find(group.front()->number);
    if (found == inquiries_.end()) continue;
    Inquiry& inquiry = found->second;
    inquiry.asked(time.now);
    Evidence evidence = weigh_group(group, status);
    evidence.finding = inquiry.hear(evidence, status.run_clock, asked, time.now);
    switch (evidence.finding) {
      case Finding::Recorded:
        for (const Report* const doubt : group) steps.push_back(this->found(*doubt, evidence));
        break;
      case Finding::NotRecorded:
        for (const Report* const doubt : group) steps.push_back(missing(*doubt, evidence));
        break;
      case Finding::Contradicts:
        account_.distrust(evidence.why, time.stamp);
        inquiries_.clear();
        explain(all(), "", time);
        return {};
      case Finding::Silent:
        explain(group, evidence.why, time);
        break;
    }
  }
  // The others are the operator's.
  Reports others = all();
  std::erase_if(others,
                [this](const Report* doubt) { return inquiries_.contains(leader_of(*doubt)->number); });
  explain(others, "", time);
  return steps;
}

void Doubts::count(Instant asked, Time time) {
  const Reports doubts = all();
  std::erase_if(inquiries_, [&](const auto& each) {
    return std::ranges::find(doubts, each.first, &Report::number) == doubts.end();
  });
  if (account_.is_stopped()) return;
  std::vector<Report> counted;
  for (const Report* const doubt : doubts) {
    const Instant lost = lost_.try_emplace(doubt->number, time.now).first->second;
    if (!doubt->counted && asked - lost >= policy_.doubt_for) counted.emplace_back(*doubt).counted = true;
  }
  book_.note(counted);
}

ReportBook::Step Doubts::found(const Report& doubt, const Evidence& evidence) const {
  const auto edit = [this, evidence](Report& report) {
    report.status = static_cast<int>(icd::Status::Created);
    report.content_type = codec::kJson;
    report.answer = reconciled_answer(report, account_.run(), evidence.points_each, evidence.why);
    report.reconciled = true;
  };
  return {doubt.number, ReportEvent::Found, "found recorded: " + evidence.why, edit};
}

/// The operator may have sent the same report since. Then this one is held.
ReportBook::Step Doubts::missing(const Report& doubt, const Evidence& evidence) const {
  const Report* const same = doubt.asked ? nullptr : review_.twin(doubt);
  if (same != nullptr) {
    return {.number = doubt.number,
            .event = ReportEvent::Held,
            .note = icd::sentence("not recorded, and report ", same->number, " is the same and is ",
                                  shown_name_of(same->state), " in this run")};
  }
  if (doubt.tries >= kMostTries) {
    return {.number = doubt.number,
            .event = ReportEvent::Held,
            .note = icd::sentence("sent ", doubt.tries, " times without an answer, and not recorded")};
  }
  return {.number = doubt.number, .event = ReportEvent::Missing, .note = "not recorded: " + evidence.why};
}

void Doubts::explain(const Reports& doubts, const std::string& seen, Time time) {
  std::vector<Report> noted;
  for (const Report* const doubt : doubts) {
    if (doubt->is_lost()) continue;  // its note is complete
    const std::string why = undecidable(*doubt);
    const std::string note =
        is_asking(*doubt) ? "asking for the run's status: " + seen : (why.empty() ? seen : why) + kOperator;
    if (doubt->note == note) continue;
    Report& report = noted.emplace_back(*doubt);
    report.note = note;
    report.changed = time.stamp;
  }
  book_.note(noted);
}

/// A counted doubt explains no change since a later one was sent.
bool Doubts::blur(std::int64_t decided, Time time) {
  const Report& report = book_.at(decided);
  std::vector<Report> blurred;
  for (const Report* const doubt : book_.doubts(report.run)) {
    if (doubt->number == decided || !doubt->before) continue;
    if (report.counted && doubt->sending > report.sending) continue;
    Report& other = blurred.emplace_back(*doubt);
    if (report.counted) {
      ++other.beside;
    } else {
      other.before.reset();
      other.uncertain =
          icd::sentence("the operator decided about report ", decided, ", which was in doubt, too");
    }
  }
  if (!book_.note(blurred)) return false;
  if (report.run != account_.run().number) return true;  // no inquiry there
  if (!report.counted) account_.lose(time.now + policy_.doubt_for);
  begin(time.now);
  return true;
}

void Doubts::ask_for_others(Time time) {
  begin(time.now);
  explain(all(), "", time);
}

void Doubts::leave_to_operator(const std::string& why, Time time) {
  std::vector<Report> left;
  for (const Report* const doubt : all()) {
    if (!doubt->uncertain.empty()) continue;
    Report& report = left.emplace_back(*doubt);
    report.before.reset();
    report.uncertain = why;
    report.changed = time.stamp;
  }
  if (!left.empty()) book_.change(left, account_.run());
  begin(time.now);
  explain(all(), "", time);
}

}  // namespace adit::dispatch
