// The connection between Adit and the Command Post.
#include <utility>

#include "dispatch/model/world.hpp"
#include "icd/sentence.hpp"

namespace adit::dispatch::model {
namespace {

/// Longest delay until the Command Post records a request of a dropped connection. Less than `doubt_for`.
constexpr Seconds kLatest = 9;
constexpr Seconds kRoundTrip = 0.02;

}  // namespace

void World::pump() {
  if (busy_) return;
  const NextRequests requests = reports_->next_requests(time());
  if (requests.report && now_ >= report_ready_) {
    if (const Report* const report = reports_->choose(time())) transmit(*report);
    return;
  }
  const bool wanted = (requests.status && *requests.status <= time().now) || now_ >= poll_at_;
  if (wanted && now_ >= status_ready_) ask();
}

void World::record_at(const std::shared_ptr<Pending>& pending) {
  later(
      pending->at - now_,
      [this, pending] {
        if (pending->done || pending->at > now_ + 1e-9) return;
        pending->done = true;
        tell_story(icd::sentence("recorded ", pending->report.position.x));
        HttpAnswer answer = pending->post->record(pending->report, now_);
        if (pending->then) pending->then(std::move(answer));
      },
      false);
}

void World::record_later(Seconds delay, const icd::ArtifactReport& report,
                         std::function<void(HttpAnswer)> then) {
  auto pending = std::make_shared<Pending>(Pending{report, &post(), now_ + delay, std::move(then)});
  pending_.push_back(pending);
  record_at(pending);
}

void World::transmit(const Report& report) {
  busy_ = true;
  report_ready_ = now_ + 1;
  const auto answer = [this](Seconds delay, HttpAnswer said) {
    later(delay, [this, said = std::move(said)] {
      busy_ = false;
      tell_story(icd::sentence("answered ", said.status));
      reports_->on_answered(said, time());
    });
  };
  const auto lose = [this](Seconds delay) {
    later(delay, [this] {
      busy_ = false;
      tell_story("lost");
      reports_->on_lost("no answer", time());
    });
  };
  if (!is_anybody_there()) {
    later(between(0, 3), [this] {
      busy_ = false;
      reports_->on_never_sent("nobody is there", time());
    });
    return;
  }
  double dice = calm_ ? 1 : chance();
  const auto falls = [&dice](double probability) { return (dice -= probability) < 0; };
  const Seconds lost_after = chance() < 0.5 ? kRoundTrip : between(0.1, 10);
  if (falls(trouble_.answer_lost)) {
    record_later(kRoundTrip / 2, report.report, nullptr);
    lose(lost_after);
  } else if (falls(trouble_.request_lost)) {
    lose(lost_after);
  } else if (falls(trouble_.late)) {
    record_later(lost_after + between(0, kLatest), report.report, nullptr);
    lose(lost_after);
  } else if (falls(trouble_.never_left)) {
    later(between(0, 3), [this] {
      busy_ = false;
      reports_->on_never_sent("no way", time());
    });
  } else if (falls(trouble_.throttled)) {
    answer(kRoundTrip, {429, "application/json", "\"too many\""});
  } else if (falls(trouble_.barred)) {
    answer(kRoundTrip, {401, "application/json", "\"no token\""});
  } else if (falls(trouble_.refused)) {
    answer(kRoundTrip, {422, "application/json", "\"no\""});
  } else if (falls(trouble_.server_error)) {
    if (chance() < 0.5) record_later(kRoundTrip / 2, report.report, nullptr);
    answer(kRoundTrip, {500, "text/html", "<html>"});
  } else {
    const std::int64_t life = life_;
    record_later(kRoundTrip / 2, report.report, [answer, this, life](HttpAnswer said) {
      if (life == life_) answer(kRoundTrip / 2, std::move(said));
    });
  }
}

void World::ask() {
  busy_ = true;
  status_ready_ = now_ + 1;
  poll_at_ = now_ + 10;
  const bool fails = !calm_ && chance() < trouble_.status_fails;
  if (fails || !is_anybody_there()) {
    const NoStatus why = chance() < 0.5 || !is_anybody_there() ? NoStatus::NoAnswer
                         : chance() < 0.5                      ? NoStatus::Page
                                                               : NoStatus::Other;
    later(between(0, 3), [this, why] {
      busy_ = false;
      reports_->on_status_failed(why, time());
    });
    return;
  }
  later(kRoundTrip / 2, [this, asked = time().now] {
    later(kRoundTrip / 2, [this, asked, status = post().status(now_)] {
      busy_ = false;
      tell_story(icd::sentence("status: ", status.remaining_reports, " left, score ", status.score));
      reports_->on_status(status, asked, time());
    });
  });
}

void World::drop_connections() {
  for (const auto& pending : pending_) {
    if (!pending->done && pending->at > now_ + kLatest) {
      pending->at = now_ + between(0, kLatest);
      record_at(pending);
    }
  }
}

}  // namespace adit::dispatch::model
