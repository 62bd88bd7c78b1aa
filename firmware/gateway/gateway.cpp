#include "gateway/gateway.hpp"

#include <set>

#include "dispatch/another_post.hpp"
#include "gateway/report_rows.hpp"
#include "host/log.hpp"
#include "host/random.hpp"
#include "loop/guard.hpp"
#include "settings/written.hpp"

namespace adit::gateway {
namespace {

constexpr std::chrono::milliseconds kDrainStep{10};
constexpr std::chrono::milliseconds kFlush{50};  // in which the answers just given to the team leave
constexpr std::size_t kMeterSeconds = 5;
constexpr std::chrono::minutes kKeepSessionsEvery{1};
/// Seconds by which the system's clock was ahead of what it should have been: somebody has set it.
constexpr double kClockWasSet = 1;

/// What is in the runtime folder beside maps: of the journal, which is made smaller beside itself, four times
/// what waits, what is set aside, and what others keep there.
std::uint64_t beside_maps(const settings::Settings& settings) {
  constexpr std::uint64_t kOthers = 8u << 20;
  return 4 * std::uint64_t{settings.queues.marker_bytes} + lanes::SetAside::kMostBytes + kOthers;
}

std::uint64_t seed() {
  std::uint64_t seed = 0;
  host::fill_random({reinterpret_cast<std::uint8_t*>(&seed), sizeof seed});
  return seed;
}

}  // namespace

Gateway::Gateway(loop::Loop& loop, Parts parts)
    : loop_(loop),
      parts_(std::move(parts)),
      settings_(settings::in_use(parts_.loaded.settings)),
      random_(seed()),
      spool_(parts_.runtime_folder + "/waiting", beside_maps(settings_)),
      stamp_floor_(parts_.state_folder),
      writer_(loop),
      disk_writer_(loop),
      workers_(loop, 0),
      log_ins_(loop, 1),
      journal_(loop, parts_.runtime_folder + "/journal"),
      aside_(loop, writer_, parts_.runtime_folder + "/aside"),
      record_([this] { changed(); }),
      scoring_(loop, parts_.ledger, settings_, token_for("scoring", settings_, parts_.loaded.secrets),
               record_, random_, journal_, [this] { make_way(); }),
      picture_(
          loop, workers_, [this] { return maps_.packing(); }, [this] { changed(); },
          parts_.legacy ? std::move(parts_.legacy->picture) : picture::Mosaic()),
      maps_(loop, workers_, writer_, spool_, settings_,
            token_for("mapping", settings_, parts_.loaded.secrets), record_, aside_, random_, journal_,
            [this](icd::MapUpdate map) { picture_.forwarded(std::move(map)); }),
      as_forwarded_(parts_.legacy ? std::move(parts_.legacy->as_forwarded) : forward::AsForwarded()),
      news_(loop, settings_, token_for("mapping", settings_, parts_.loaded.secrets), record_, aside_, random_,
            journal_, as_forwarded_, [this] { make_way(); }),
      lights_(loop, std::move(parts_.lines)),
      links_(
          loop, settings_, host::carrier, [this] { changed(); }, [this] { link_is_back(); }),
      button_(loop, std::move(parts_.button), lights_, [this](panel::Press press) { pressed(press); }),
      roster_(settings_.robots),
      sessions_(parts_.runtime_folder + '/' + SessionKeeper::kFile, loop.now()),
      accounts_(loop, log_ins_, disk_writer_, sessions_, parts_.state_folder,
                parts_.loaded.secrets.label_code),
      network_requests_(parts_.state_folder, parts_.network_folder),
      setup_(
          parts_.store, parts_.reset, parts_.loaded,
          [this](const std::string& post) {
            return dispatch::meaning_of_another_post(scoring_.reports(), post);
          },
          [this] { make_way(); }),
      box_(loop, workers_, parts_.board, settings::file_of(parts_.loaded.settings),
           [this](page::Usage& usage) { add_to(usage); }),
      network_(loop, settings_, network_requests_),
      self_test_(loop, settings_,
                 {token_for("scoring", settings_, parts_.loaded.secrets),
                  token_for("mapping", settings_, parts_.loaded.secrets)},
                 network_requests_, network_, [this] { changed(); }),
      updates_(loop, disk_writer_, UpdateRequests(parts_.state_folder, parts_.update_folder),
               [this] { return report_under_way(); }),
      page_(loop, *this, *this, accounts_, tokens()),
      routes_(icd_options(), *this, workers_, page_),
      second_(loop.timer([this] { every_second(); })),
      drained_(loop.timer([this] { drain(); })),
      pictured_run_(parts_.legacy ? parts_.legacy->pictured_run : 0) {
  if (!parts_.ledger.refusal().empty()) {
    ledger_return_.emplace(loop, disk_writer_, parts_.state_folder, parts_.ledger_rest,
                           [this] { ledger_is_back(); });
  }
  page_.serve(setup_);
  page_.serve(box_);
  page_.serve(network_, self_test_);
  page_.serve(updates_);
}

Gateway::~Gateway() = default;

intake::IcdOptions Gateway::icd_options() const {
  intake::IcdOptions options;
  options.rules = settings_.rules;
  options.asks_token = settings_.team.require_token;
  options.tokens = tokens();
  return options;
}

/// Any of them lets a client of the team in.
std::vector<icd::BearerToken> Gateway::tokens() const {
  std::vector<icd::BearerToken> tokens;
  tokens.reserve(parts_.loaded.secrets.tokens.size());
  for (const auto& [name, token] : parts_.loaded.secrets.tokens) tokens.push_back(token);
  return tokens;
}

void Gateway::ledger_is_back() {
  host::log(host::Level::Notice, "the state folder can be written to again: beginning anew with its ledger");
  make_way();
}

/// When the gateway before sent last is not known, and the Command Post sees too much of neither.
void Gateway::hold_back() {
  scoring_.hold_back();
  maps_.hold_back();
  news_.hold_back();
}

/// Nothing waits for what it would have waited for without a cable.
void Gateway::link_is_back() {
  scoring_.link_is_back();
  maps_.link_is_back();
  news_.link_is_back();
}

std::expected<void, std::string> Gateway::start() {
  carry_on();
  if (auto started = scoring_.start(); !started) return started;
  news_.start();
  if (auto listening = listen(); !listening) return listening;
  every_second();
  return {};
}

std::expected<void, std::string> Gateway::listen() {
  const settings::Team& team = settings_.team;
  auto open = parts_.sockets.open(team);
  if (!open) return std::unexpected(std::move(open.error()));
  for (ListenSockets::Open& each : *open) {
    auto server = intake::Server::start(loop_,
                                        {.address = each.at.address,
                                         .port = each.at.port,
                                         .interface = each.at.interface,
                                         .connections = team.connections,
                                         .connections_per_address = team.connections_per_address},
                                        routes_, std::move(each.socket));
    if (!server) return std::unexpected(server.error());
    host::log(host::Level::Notice, "listening",
              {{"address", each.at.address},
               {"port", std::to_string(each.at.port)},
               {"interface", each.at.interface}});
    servers_.push_back(std::move(*server));
  }
  return {};
}

/// Takes up what the life before left, in this process or another: rates and stamps go on as if nothing had
/// been.
void Gateway::carry_on() {
  journal::Carried carried = journal_.read();
  const std::string boot = host::boot();
  const bool is_first = !carried.clock();
  const double floor = stamp_floor_.read();
  carried.machine_is(boot);
  const auto& clock = carried.clock();
  if (clock) {
    const double due = clock->stamp + std::chrono::duration<double>(loop_.now() - clock->at).count();
    const double set_ahead = loop_.stamp_now() - due;
    stamps_ = carried.senders();
    if (set_ahead < kClockWasSet) {
      loop_.set_stamp(due);
    } else {
      stamps_.move(set_ahead);
    }
  } else if (floor > loop_.stamp_now()) {
    loop_.set_stamp(floor);  // the machine has no clock that went on
  }
  journal_.begin({.boot = boot, .at = loop_.now(), .stamp = loop_.stamp_now()});
  for (const auto& [sender, its] : stamps_.clocks()) journal_.sender(sender, its);  // they may have moved
  if (is_first && parts_.legacy) hold_back();
  scoring_.carry_on(carried);
  maps_.carry_on(carried);
  news_.carry_on(carried);
  restore(is_first);
}

/// What is kept in files of its own. What a release before the journal left is stamped anew, and waits: what
/// that sent last, and when, is not known.
void Gateway::restore(bool is_first) {
  aside_.restore();
  spool::Spool::Kept kept = spool_.read();
  const double now = loop_.stamp_now();
  const bool is_left = !kept.maps.empty() || !kept.state.poses.empty() || !kept.markers.markers.empty();
  if (is_first && is_left) hold_back();
  for (auto& [number, map] : kept.maps) {
    if (is_first) map.header().stamp = now;
    maps_.restore(number, std::move(map));
  }
  kept.state.header.stamp = now;
  for (icd::Marker& marker : kept.markers.markers) marker.header.stamp = now;
  // The lanes are empty: there is room. What cannot be kept in the journal stays in its file; the other is
  // not taken twice, for what came since is newer.
  if (kept.state.poses.empty() || news_.take(kept.state, 0)) spool_.forget_state();
  if (kept.markers.markers.empty() || news_.take(kept.markers, 0)) spool_.forget_markers();
}

void Gateway::stop() {
  host::notify_stopping();
  host::log(host::Level::Notice, "stopping");
  makes_way_ = false;
  end();
}

/// A stop that has begun stays one.
void Gateway::make_way() {
  if (stop_by_) return;
  makes_way_ = true;
  end();
}

void Gateway::end() {
  if (stop_by_) return;
  stop_by_ = loop_.now() + kDrain;
  drained_.call_at(loop_.now() + kDrainStep);  // first: whatever fails below, the end comes
  for (const auto& server : servers_) server->stop_listening();
  routes_.stop();
  drain();
}

void Gateway::drain() {
  const bool is_late = loop_.now() >= *stop_by_ + 2 * kKeepWithin;  // something fails again and again
  if (dismissed_ || is_late) return finish();
  drained_.call_at(loop_.now() + kDrainStep);
  const bool scoring = scoring_.stop(), maps = maps_.stop(), news = news_.stop();
  const bool kept = (maps_.all_kept() && aside_.all_kept()) || loop_.now() >= *stop_by_ + kKeepWithin;
  dismissed_ = kept && ((scoring && maps && news) || loop_.now() >= *stop_by_);
  if (!dismissed_) return;
  drained_.call_at(loop_.now() + kFlush);
  scoring_.dismiss();
}

void Gateway::finish() {
  loop_.stop();
  if (!sessions_.sessions().in_order().empty()) sessions_.keep();
}

/// On the gateway's clock. The journal keeps how the sender's goes, so that a life to come goes on with it.
icd::Stamp Gateway::stamped_here(const std::string& clock, std::optional<icd::Stamp> stamp,
                                 std::uint64_t connection) {
  const icd::Stamp shifted = stamps_.shift(clock, stamp, loop_.stamp_now(), connection);
  keep_clock(clock);
  return shifted;
}

void Gateway::keep_clock(const std::string& clock) {
  if (const lanes::SenderClock* its = stamps_.clock_of(clock)) journal_.sender(clock, *its);
}

std::shared_ptr<intake::MapArrival> Gateway::map_arrives() {
  return maps_.arrives([this](icd::MapUpdate update, const intake::Sender& sender,
                              std::shared_ptr<spool::MapFile> file,
                              std::function<void(icd::Checked<void>)> done) {
    take(std::move(update), sender, std::move(file), std::move(done));
  });
}

void Gateway::take(icd::MapUpdate update, const intake::Sender& sender, std::shared_ptr<spool::MapFile> file,
                   std::function<void(icd::Checked<void>)> done) {
  const std::string clock = sender.address + "/map/" + (update.name ? update.name->text() : "");
  if (update.name) note_robot(update.name->text());
  update.header().stamp = stamped_here(clock, update.header().stamp, sender.connection);
  maps_.take(std::move(update), sender.bytes, std::move(file), std::move(done));
}

icd::Checked<void> Gateway::take(const icd::StateUpdate& update, const intake::Sender& sender) {
  const std::string robot = update.poses.size() == 1 ? update.poses.front().name.text() : "";
  for (const icd::NamedPose& pose : update.poses) note_robot(pose.name.text());
  icd::StateUpdate shifted = update;
  shifted.header.stamp =
      stamped_here(sender.address + "/state/" + robot, update.header.stamp, sender.connection);
  return news_.take(shifted, sender.bytes);
}

/// The markers of one message have stamps of their own, in no order.
icd::Checked<void> Gateway::take(const icd::MarkersUpdate& update, const intake::Sender& sender) {
  icd::MarkersUpdate shifted = update;
  std::set<std::string> clocks;
  for (icd::Marker& marker : shifted.markers) {
    const auto clock = clocks.insert(sender.address + "/markers/" + marker.ns).first;
    marker.header.stamp = stamps_.shift(*clock, marker.header.stamp, loop_.stamp_now());
  }
  for (const std::string& clock : clocks) keep_clock(clock);
  return news_.take(shifted, sender.bytes);
}

void Gateway::note_robot(const std::string& name) {
  if (roster_.posted(name, loop_.now())) host::log(host::Level::Warning, roster_.sentence(name));
}

void Gateway::take(const icd::ArtifactReport& report, const intake::Sender& sender,
                   std::shared_ptr<intake::Responder> responder) {
  scoring_.take(report, sender, std::move(responder));
}

void Gateway::status(const intake::Sender&, std::shared_ptr<intake::Responder> responder) {
  scoring_.status(std::move(responder));
}

/// The sentence quotes what was sent, which may be a token that was put into a wrong field.
void Gateway::refused(icd::Uri uri, const intake::Sender& sender, const icd::Refusal& told) {
  icd::Refusal refusal = told;
  for (const icd::BearerToken& token : tokens()) token.strike_from(refusal.sentence);
  host::log(host::Level::Info, "refused",
            {{"uri", std::string(icd::path_of(uri))},
             {"sender", sender.address},
             {"status", std::to_string(static_cast<int>(refusal.status))},
             {"why", refusal.sentence}});
  record_.refused(uri, sender, refusal, loop_.stamp_now());
}

std::vector<page::ReportRow> Gateway::reports() const {
  return all_rows(scoring_.reports());
}

std::optional<page::ReportDetail> Gateway::report(std::int64_t number) const {
  return detail_of(scoring_.reports(), parts_.ledger, number);
}

std::expected<std::int64_t, std::string> Gateway::judge(std::int64_t number, page::Deed deed) {
  return scoring_.judge(number, deed);
}

std::expected<std::int64_t, std::string> Gateway::report(const icd::ArtifactReport& report, bool resubmit) {
  return scoring_.report(report, resubmit);
}

std::expected<void, std::string> Gateway::aside(std::uint64_t number, page::AsideDeed deed) {
  if (stop_by_) return std::unexpected("the gateway is stopping: nothing is sent any more");
  if (deed == page::AsideDeed::Discard) return aside_.discard(number);
  auto message = aside_.to_be_sent(number);
  if (!message) return std::unexpected(message.error());
  if (auto* const map = std::get_if<icd::MapUpdate>(&*message)) {
    maps_.send_again(std::move(*map), [this, number](bool kept) { aside_.sent_again(number, kept); });
  } else {
    aside_.sent_again(number, news_.send_again(*message));
  }
  return {};
}

std::int64_t Gateway::begin_run() {
  return scoring_.begin_run();
}

void Gateway::changed() {
  picture_the_run();
  page_.changed();
}

/// A new run begins with a blank picture.
void Gateway::picture_the_run() {
  const std::int64_t run = scoring_.reports().run().number;
  const std::int64_t before = std::exchange(pictured_run_, run);
  if (before == 0 || before == run) return;
  as_forwarded_.begin_run(loop_.stamp_now());
  picture_.begin_run();
}

void Gateway::every_second() {
  second_.call_at(loop_.now() +
                  std::chrono::seconds(1));  // first: whatever fails below, the next second comes
  bytes_sent_.push_back(sent_bytes());
  if (bytes_sent_.size() > kMeterSeconds + 1) bytes_sent_.pop_front();
  scoring_.tick();
  show_lights();
  network_.lead_to_endpoints();
  keep_sessions();
  keep_stamp_floor();
  look_at_sockets();
  if (std::string line = status_line(); line != notified_) {
    host::notify_status(line);
    notified_ = std::move(line);
  }
}

/// The team's interface came back as another one.
void Gateway::look_at_sockets() {
  const ListenSockets::Reach reach = parts_.sockets.reach();
  if (reach == ListenSockets::Reach::Well || stop_by_) return;
  host::log(host::Level::Warning, "the team's interface is a new one: listening anew");
  reach == ListenSockets::Reach::Anew ? make_way() : stop();
}

/// By the disk's own writer: it may wait long.
void Gateway::keep_stamp_floor() {
  const auto floor = stamp_floor_.due(loop_.stamp_now());
  if (floor) disk_writer_.submit([kept = stamp_floor_, floor = *floor] { kept.write(floor); }, [] {});
}

/// When somebody was seen last need not be known to the second.
void Gateway::keep_sessions() {
  if (loop_.now() < sessions_kept_ + kKeepSessionsEvery) return;
  sessions_kept_ = loop_.now();
  if (!sessions_.sessions().in_order().empty()) sessions_.keep();
}

std::uint64_t Gateway::sent_bytes() const {
  return scoring_.channel().bytes_sent() + maps_.channel().bytes_sent() + news_.channel().bytes_sent();
}

void Gateway::add_to(page::Usage& usage) const {
  for (const auto& server : servers_) usage.connections += server->connections();
  usage.sent_bytes = sent_bytes();
  usage.exceptions = loop::caught_so_far();
  usage.aside_dropped = aside_.dropped();
  usage.refused = record_.refused_counts();
}

}  // namespace adit::gateway
