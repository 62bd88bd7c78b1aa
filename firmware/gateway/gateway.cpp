#include "gateway/gateway.hpp"

#include "gateway/report_rows.hpp"
#include "host/log.hpp"
#include "settings/written.hpp"

namespace adit::gateway {
namespace {

constexpr std::chrono::milliseconds kDrainStep{10};
constexpr std::chrono::milliseconds kFlush{50};  // in which the answers just given to the team leave
constexpr std::size_t kMeterSeconds = 5;
constexpr std::chrono::minutes kKeepSessionsEvery{1};

}  // namespace

Gateway::Gateway(loop::Loop& loop, Parts parts)
    : loop_(loop),
      parts_(std::move(parts)),
      settings_(settings::in_use(parts_.loaded.settings)),
      random_(std::random_device{}()),
      workers_(loop, 0),
      spool_(parts_.runtime_folder + "/waiting"),
      record_([this] { changed(); }),
      scoring_(loop, parts_.ledger, settings_, token_for("scoring", settings_, parts_.loaded.secrets),
               record_, random_),
      picture_(
          loop, workers_, [this] { return maps_.packing(); }, [this] { changed(); },
          parts_.legacy ? std::move(parts_.legacy->picture) : picture::Mosaic()),
      maps_(loop, workers_, spool_, settings_, token_for("mapping", settings_, parts_.loaded.secrets),
            record_, random_, [this](icd::MapUpdate map) { picture_.forwarded(std::move(map)); }),
      as_forwarded_(parts_.legacy ? std::move(parts_.legacy->as_forwarded) : AsForwarded()),
      news_(loop, settings_, token_for("mapping", settings_, parts_.loaded.secrets), record_, random_,
            as_forwarded_),
      lights_(loop, std::move(parts_.lines)),
      links_(
          loop, settings_, host::carrier, [this] { changed(); }, [this] { link_is_back(); }),
      button_(loop, std::move(parts_.button), lights_, [this](panel::Press press) { pressed(press); }),
      roster_(settings_.robots),
      sessions_(parts_.runtime_folder + '/' + SessionKeeper::kFile, loop.now()),
      accounts_(loop, workers_, sessions_, parts_.state_folder, parts_.loaded.secrets.label_code),
      network_requests_(parts_.state_folder, parts_.network_folder),
      setup_(parts_.store, parts_.reset, parts_.loaded, [this] { make_way(); }),
      box_(loop, workers_, parts_.board, settings::file_of(parts_.loaded.settings),
           [this](page::Usage& usage) { add_to(usage); }),
      network_(loop, settings_, network_requests_),
      self_test_(loop, settings_,
                 {token_for("scoring", settings_, parts_.loaded.secrets),
                  token_for("mapping", settings_, parts_.loaded.secrets)},
                 network_requests_, network_, [this] { changed(); }),
      updates_(loop, workers_, UpdateRequests(parts_.state_folder, parts_.update_folder),
               [this] { return report_under_way(); }),
      page_(loop, *this, *this, accounts_, tokens()),
      routes_(icd_options(), *this, workers_, page_),
      second_(loop.timer([this] { every_second(); })),
      drained_(loop.timer([this] { drain(); })),
      pictured_run_(parts_.legacy ? parts_.legacy->pictured_run : 0) {
  page_.serve(setup_);
  page_.serve(box_);
  page_.serve(network_, self_test_);
  page_.serve(updates_);
  if (parts_.legacy) hold_back();
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
  if (auto started = scoring_.start(); !started) return started;
  news_.start();
  restore();
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

/// What an earlier service left, stamped anew: what it sent last is not known, and stamps must not run
/// backward.
void Gateway::restore() {
  Spool::Kept kept = spool_.read(settings_.rules);
  const double now = loop_.stamp_now();
  for (auto& [number, map] : kept.maps) {
    map.header().stamp = now;
    maps_.restore(number, std::move(map));
  }
  kept.state.header.stamp = now;
  for (icd::Marker& marker : kept.markers.markers) marker.header.stamp = now;
  if (!kept.state.poses.empty()) (void)news_.take(kept.state, 0);  // the lanes are empty: there is room
  if (!kept.markers.markers.empty()) (void)news_.take(kept.markers, 0);
}

/// On a worker, and one at a time: there may be many markers.
void Gateway::keep_news() {
  if (keeping_news_ || !news_.changed_since_asked()) return;
  keeping_news_ = true;
  workers_.submit([&spool = spool_, state = news_.unsent_state(),
                   markers = news_.unsent_markers()] { spool.keep(state, markers); },
                  [this] { keeping_news_ = false; });
}

void Gateway::stop() {
  host::notify_stopping();
  host::log(host::Level::Notice, "stopping");
  makes_way_ = false;
  end();
}

void Gateway::make_way() {
  makes_way_ = true;
  end();
}

void Gateway::end() {
  if (stop_by_) return;
  stop_by_ = loop_.now() + kDrain;
  for (const auto& server : servers_) server->stop_listening();
  drain();
}

void Gateway::drain() {
  if (dismissed_) return finish();
  const bool scoring = scoring_.stop(), maps = maps_.stop(), news = news_.stop();
  dismissed_ = (scoring && maps && news && !keeping_news_) || loop_.now() >= *stop_by_;
  if (dismissed_) scoring_.dismiss();
  drained_.call_at(loop_.now() + (dismissed_ ? kFlush : kDrainStep));
}

void Gateway::finish() {
  if (!sessions_.sessions().in_order().empty()) sessions_.keep();
  if (!keeping_news_) spool_.keep(news_.unsent_state(), news_.unsent_markers());
  loop_.stop();
}

icd::Checked<void> Gateway::take(icd::MapUpdate update, const intake::Sender& sender) {
  const std::string clock = sender.address + "/map/" + (update.name ? update.name->text() : "");
  if (update.name) note_robot(update.name->text());
  update.header().stamp = stamps_.shift(clock, update.header().stamp, loop_.stamp_now());
  return maps_.take(std::move(update), sender.bytes);
}

icd::Checked<void> Gateway::take(const icd::StateUpdate& update, const intake::Sender& sender) {
  const std::string robot = update.poses.size() == 1 ? update.poses.front().name.text() : "";
  for (const icd::NamedPose& pose : update.poses) note_robot(pose.name.text());
  icd::StateUpdate shifted = update;
  shifted.header.stamp =
      stamps_.shift(sender.address + "/state/" + robot, update.header.stamp, loop_.stamp_now());
  return news_.take(shifted, sender.bytes);
}

icd::Checked<void> Gateway::take(const icd::MarkersUpdate& update, const intake::Sender& sender) {
  icd::MarkersUpdate shifted = update;
  for (icd::Marker& marker : shifted.markers) {
    marker.header.stamp =
        stamps_.shift(sender.address + "/markers/" + marker.ns, marker.header.stamp, loop_.stamp_now());
  }
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
  bytes_sent_.push_back(sent_bytes());
  if (bytes_sent_.size() > kMeterSeconds + 1) bytes_sent_.pop_front();
  scoring_.tick();
  show_lights();
  network_.lead_to_endpoints();
  keep_news();
  keep_sessions();
  look_at_sockets();
  if (std::string line = status_line(); line != notified_) {
    host::notify_status(line);
    notified_ = std::move(line);
  }
  second_.call_at(loop_.now() + std::chrono::seconds(1));
}

/// The team's interface came back as another one.
void Gateway::look_at_sockets() {
  const ListenSockets::Reach reach = parts_.sockets.reach();
  if (reach == ListenSockets::Reach::Well || stop_by_) return;
  host::log(host::Level::Warning, "the team's interface is a new one: listening anew");
  reach == ListenSockets::Reach::Anew ? make_way() : stop();
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
  usage.refused = record_.refused_counts();
}

}  // namespace adit::gateway
