#include "gateway/gateway.hpp"

#include <algorithm>
#include <cerrno>
#include <utility>

#include "box/self_test.hpp"
#include "box/version.hpp"
#include "dispatch/reports.hpp"
#include "forward/clocks.hpp"
#include "host/files.hpp"
#include "host/interfaces.hpp"
#include "host/log.hpp"
#include "host/systemd.hpp"
#include "icd/sentence.hpp"
#include "icd/try.hpp"
#include "panel/states.hpp"
#include "settings/subnet.hpp"
#include "settings/written.hpp"
#include "spare/sealed.hpp"

namespace adit::gateway {

std::string team_address(const settings::Team& team) {
  if (!team.interface.empty()) {
    const auto own = host::own_address(team.interface);
    host::log_failure(host::Level::Warning, "the team's address is unknown", own);
    return own && *own ? settings::ipv4_text((*own)->address) : "";
  }
  const auto given = std::ranges::find_if(team.listen, [](const settings::Address& each) {
    return settings::ipv4_of(each.address).value_or(0) != 0;
  });
  return given == team.listen.end() ? "" : given->address;
}

namespace {

constexpr std::chrono::minutes kKeepSessionsEvery{1};
constexpr std::chrono::seconds kAnswerLeaves{1};

/// The files of Gateway::unread().
bool can_be_read(const std::string& state_folder) {
  for (const char* const name :
       {admin::Accounts::kFile, admin::Accounts::kCodeFile, forward::StampFloor::kFile,
        admin::Takeover::kFile, admin::FactoryReset::kFile, admin::SpareFile::kName}) {
    const auto file = host::slurp(state_folder + '/' + name, spare::kLargestExport);
    if (!file && file.error() != ENOENT) return false;
  }
  return true;
}

/// Why a restart is harmful now, or "".
std::string report_under_way(const dispatch::Reports& reports) {
  if (const auto* report = reports.sending())
    return icd::sentence("report ", report->number, " is in flight; a restart would leave it in doubt");
  const std::size_t waiting = reports.waiting_here().size();
  if (waiting == 0) return "";
  return icd::sentence(waiting, waiting == 1 ? " report is" : " reports are", " queued");
}

/// What another box needs to take over. `stamp`: now; no stamp is used after the export.
std::expected<spare::Content, std::string> export_of(const Parts& parts, const dispatch::Reports& reports,
                                                     const settings::Team& team, double stamp) {
  auto ledger = parts.ledger.copy();
  if (!ledger) return std::unexpected(std::move(ledger.error().what));
  spare::Content content;
  content.about.name = team_address(team);
  content.about.version = box::kVersion;
  content.about.stamps = stamp + forward::StampFloor::kAhead;
  content.about.reports = static_cast<std::int64_t>(reports.book().all().size());
  content.about.open = static_cast<std::int64_t>(reports.book().open().size());
  content.about.post = reports.run().post;
  content.about.run = reports.run().last;
  content.settings = settings::file_of(parts.loaded.settings);
  content.tokens = {parts.loaded.secrets.tokens.begin(), parts.loaded.secrets.tokens.end()};
  content.ledger = *std::move(ledger);
  auto certificate = ADIT_TRY(host::read_optional_file(parts.options.state + '/' + access::kCertificateFile));
  content.certificate = std::move(certificate).value_or("");
  return content;
}

}  // namespace

Gateway::Gateway(loop::Loop& loop, Parts parts)
    : loop_(loop),
      parts_(std::move(parts)),
      settings_(settings::effective_settings(parts_.loaded.settings)),
      disk_writer_(loop),
      flow_(loop, parts_.ledger, settings_, tokens(), {parts_.runtime_folder, parts_.options.state},
            {.on_changed = [this] { api_.on_changed(); },
             .on_posted = [this](const std::string& name) { overview_.on_posted(name); }}),
      log_ins_(loop, 1),
      lights_(loop, std::move(parts_.lines)),
      links_(
          loop, settings_, host::carrier, host::link_changes(), [this] { api_.on_changed(); },
          [this] { flow_.on_link_up(); }),
      button_(loop, std::move(parts_.button), lights_, [this](panel::Press press) { on_pressed(press); }),
      sessions_(parts_.runtime_folder + '/' + admin::SessionKeeper::kFile, loop.now()),
      accounts_(loop, log_ins_, disk_writer_, sessions_, parts_.options.state,
                parts_.loaded.secrets.label_code),
      adit_network_(loop, "adit-network", parts_.options.state, parts_.options.network,
                    admin::NetworkChange::kTakenUpWithin),
      setup_(
          parts_.store, parts_.reset, parts_.loaded, parts_.trouble,
          [this](const std::string& post) {
            return dispatch::describe_command_post_change(flow_.reports(), post);
          },
          [this] { change_.call_at(loop_.now()); }, [this] { make_way(); }),
      box_(loop, flow_.workers(), parts_.board, settings::file_of(parts_.loaded.settings),
           [this](api::Usage& usage) { overview_.add_to(usage); }),
      network_(loop, settings_, adit_network_, parts_.options.watch),
      self_test_(
          loop, settings_,
          [this](const api::Candidate& candidate) {
            return box::tried_of(candidate, parts_.loaded.settings, parts_.loaded.secrets);
          },
          {.are_shared =
               [this](icd::Uri uri, const settings::Address& at) {
                 const settings::CommandPost& post = settings_.command_post;
                 return at == (icd::endpoint_of(uri) == icd::Endpoint::Scoring ? post.scoring : post.mapping);
               },
           .claim = [this](icd::Uri uri, loop::Instant latest) { return flow_.claim(uri, latest); },
           .on_claimed = [this](icd::Uri uri) { flow_.on_claimed(uri); }},
          network_, [this] { api_.on_changed(); }),
      updates_(loop, disk_writer_, parts_.options.state, parts_.options.update,
               [this] { return report_under_way(flow_.reports()); }),
      clock_(loop, parts_.options.state, parts_.options.clock, admin::ClockSetting::kChronyd),
      spare_(loop, log_ins_, parts_.takeover, parts_.options.state, parts_.options.spare,
             unread().empty() ? parts_.stuck : unread(),
             {.content =
                  [this] { return export_of(parts_, flow_.reports(), settings_.team, loop_.stamp_now()); },
              .is_time_set = [this] { return clock_.is_set().value_or(false); },
              .restart = [this] { make_way(); }}),
      certificate_(loop, parts_.options.state, parts_.runtime_folder,
                   {.serves_tls = [this] { return listeners_.serves_tls(); },
                    .address = [this] { return team_address(settings_.team); }}),
      overview_({loop, parts_, settings_, flow_, lights_, links_, accounts_, network_, updates_, clock_,
                 spare_, certificate_, listeners_},
                disk_writer_),
      api_(loop,
           {.source = overview_,
            .decisions = flow_,
            .gateway_control = *this,
            .keys = accounts_,
            .setup = setup_,
            .network = network_,
            .test = self_test_,
            .updates = updates_,
            .box = box_,
            .runs = flow_.archive(),
            .clock = clock_,
            .finer = flow_.fine_map(),
            .covered = flow_.covered_map(),
            .spare = spare_,
            .certificate = certificate_},
           tokens().all, redaction()),
      routes_(icd_options(), flow_, flow_.workers(), api_),
      listeners_(
          loop, parts_.sockets, routes_, guesses_,
          [this](intake::CloseReason why, const std::string& address) { overview_.on_ended(why, address); }),
      team_ports_(loop, parts_.options.state, parts_.options.ports),
      second_(loop.timer([this] { every_second(); })),
      change_(loop.timer([this] { apply_change(); })) {}

intake::IcdOptions Gateway::icd_options() const {
  intake::IcdOptions options;
  options.rules = settings_.rules;
  options.asks_token = settings_.team.require_token && parts_.store.unread().empty();  // else all get 503
  for (const std::string_view each : settings::words(settings_.team.origins))
    options.origins.emplace_back(each);
  options.tokens = tokens().all;
  return options;
}

forward::Tokens Gateway::tokens() const {
  forward::Tokens tokens{.scoring = admin::token_for("scoring", settings_, parts_.loaded.secrets),
                         .mapping = admin::token_for("mapping", settings_, parts_.loaded.secrets),
                         .all = {}};
  for (const auto& [name, token] : parts_.loaded.secrets.tokens) tokens.all.push_back(token);
  return tokens;
}

icd::Redaction Gateway::redaction() const {
  icd::Redaction redaction = parts_.loaded.secrets.redaction();
  if (const auto& code = accounts_.code()) redaction.add(*code);
  return redaction;
}

/// Why the box must stand by: an unreadable file; or "".
std::string Gateway::unread() const {
  const std::string& settings = parts_.store.unread();
  if (!settings.empty()) return "the saved settings or tokens cannot be read: " + settings;
  const std::string& reset = parts_.reset.unread();
  if (!reset.empty()) return "it is not known whether a factory reset was begun: " + reset;
  const std::string& takeover = parts_.takeover.unread();
  if (!takeover.empty()) return "the take-over cannot be read: " + takeover;
  return accounts_.unread().empty() ? flow_.unread() : accounts_.unread();
}

bool Gateway::has_read_all() const {
  return !parts_.ledger.is_closed() && unread().empty() && spare_.unread().empty() &&
         flow_.has_read_messages();
}

void Gateway::await_files() {
  if (has_read_all()) return;
  const auto all_can_be_read = [has_ledger = !parts_.ledger.is_closed(), known = parts_.ledger.known_facts(),
                                has_messages = flow_.has_read_messages(), folder = parts_.options.state,
                                runtime = parts_.runtime_folder, &store = parts_.store] {
    const bool can = (has_ledger || ledger::Ledger::can_be_read(folder)) && store.can_be_read() &&
                     can_be_read(folder) && (has_messages || forward::Flow::can_be_read(runtime));
    // Before the restart, because a power cut in it would take what only memory knows.
    if (can) forward::StampFloor(folder).remember(known);
    return can;
  };
  file_return_.emplace(loop_, disk_writer_, all_can_be_read, parts_.file_rest,
                       [this] { on_files_readable(); });
}

std::vector<loop::Workers*> Gateway::threads() {
  std::vector<loop::Workers*> threads = flow_.threads();
  threads.insert(threads.end(), {&log_ins_, &disk_writer_});
  return threads;
}

/// The journal may have become readable by itself.
void Gateway::on_files_readable() {
  if (has_read_all()) return;
  host::log(host::Level::Notice, "all files can be read again; restarting");
  make_way();
}

std::expected<void, std::string> Gateway::start() {
  host::keep_out_of_log(redaction());
  if (!spare_.standby().empty())
    flow_.set_standby(
        icd::sentence("this box is on standby: ", spare_.standby(), "; it accepts and sends no messages"));
  flow_.start();
  await_files();
  overview_.restore();
  ADIT_TRY(listen(settings_.team));
  every_second();
  return {};
}

std::expected<void, std::string> Gateway::listen(const settings::Team& team) {
  listeners_.set_drain_time(settings_.reports.answer_within + kAnswerLeaves);
  return listeners_.serve(team);
}

void Gateway::stop() {
  host::notify_stopping();
  host::log(host::Level::Notice, "stopping");
  makes_way_ = false;
  end();
}

/// A stop in progress stays a stop.
void Gateway::make_way() {
  if (flow_.is_ending()) return;
  makes_way_ = true;
  end();
}

void Gateway::end() {
  if (flow_.is_ending()) return;
  flow_.end([this] {
    loop_.stop();
    spare_.on_end(flow_.reports().expected_status(loop_.now()));
    if (!sessions_.sessions().entries().empty()) sessions_.keep();
  });
  listeners_.stop();
  routes_.stop();
}

void Gateway::every_second() {
  second_.call_at(loop_.now() + std::chrono::seconds(1));
  check_clock();
  flow_.tick(disk_writer_);
  links_.refresh();
  overview_.update();
  show_lights();
  lights_.send_heartbeat();
  network_.every_second();
  updates_.every_second();
  certificate_.every_second();
  team_ports_.every_second(listeners_.ports());
  keep_sessions();
  check_sockets();
  listeners_.tick();
  if (std::string line = status_line(); line != notified_) {
    host::notify_status(line);
    notified_ = std::move(line);
  }
}

/// Anybody may set the time of day, in both directions. Offers better sources too.
void Gateway::check_clock() {
  if (const auto ntp = wanted_ntp()) clock_.every_second(*ntp);
  const forward::KnownTimes known = flow_.known_times();
  clock_.on_offered({clock::Source::LastKnown, loop_.wall_now()});
  clock_.on_offered({clock::Source::CommandPost, known.command_post.value_or(0)});
  clock_.on_offered({clock::Source::Robots, known.robots.value_or(0)});
  const double told = clock_.has_source() ? loop_.wall_now() : 0;
  if (const double time = std::max(told, known.command_post.value_or(0)); time > 0)
    flow_.set_known_time(time);
  const double step = loop_.check_wall_clock(clock_.is_set().value_or(false));
  if (step == 0) return;
  host::log(host::Level::Notice, "the clock was set", {{"ahead_by_s", icd::sentence(step)}});
  flow_.on_wall_set(step);
  overview_.on_wall_set(step);
  api_.on_changed();
}

std::optional<clock::Ntp> Gateway::wanted_ntp() const {
  clock::Ntp ntp{.server = settings_.clock.ntp_server, .clients = ""};
  if (!settings_.clock.serve_ntp) return ntp;
  const auto own = host::own_address(settings_.team.interface);
  if (!own) return std::nullopt;
  if (*own) ntp.clients = settings::to_text(**own);
  return ntp;
}

/// The team's interface may have been replaced.
void Gateway::check_sockets() {
  const ListenSockets::Reach reach = parts_.sockets.reach();
  if (reach == ListenSockets::Reach::Well || flow_.is_ending()) return;
  host::log(host::Level::Warning, "the team's interface was replaced; listening again");
  if (reach == ListenSockets::Reach::Reopen) return make_way();
  stop();
}

/// The last use of a session needs no exact time.
void Gateway::keep_sessions() {
  if (loop_.now() < sessions_kept_ + kKeepSessionsEvery) return;
  sessions_kept_ = loop_.now();
  if (!sessions_.sessions().entries().empty()) sessions_.keep();
}

namespace {

constexpr std::chrono::seconds kIdentify{10};  // by the button

}  // namespace

std::expected<void, std::string> Gateway::acknowledge(const std::string& id) {
  auto done = overview_.acknowledge(id);
  show_lights();
  return done;
}

void Gateway::show_lights() {
  overview_.show_on(lights_);
  if (std::exchange(told_lights_, lights_.shown_lights()) != lights_.shown_lights()) api_.on_changed();
}

api::Time Gateway::identify(double seconds) {
  const auto length = std::chrono::duration_cast<loop::Duration>(std::chrono::duration<double>(seconds));
  lights_.set_for(panel::LightState::Identify, length);
  api_.on_changed();
  return loop_.wall_now() + seconds;
}

void Gateway::on_pressed(panel::Press press) {
  accounts_.on_button_press();
  switch (press) {
    case panel::Press::Identify:
      host::log(host::Level::Notice, "the button was pressed");
      identify(std::chrono::duration<double>(kIdentify).count());
      return;
    case panel::Press::ShowAddress: {
      const std::string address = team_address(settings_.team);
      accounts_.open_set_up();
      host::log(host::Level::Notice, "the lights show the address", {{"address", address}});
      if (!address.empty()) lights_.play_digits(panel::address_digits(address));
      show_lights();
      return;
    }
    case panel::Press::Reset:
      host::log(host::Level::Warning, "button held: factory reset");
      if (const auto done = setup_.reset(); !done) {
        host::log(host::Level::Error, "the factory reset failed; hold the button again",
                  {{"why", done.error().sentence}});
      }
  }
}

/// Applies or reverts the settings on disk. If a file is unreadable, now or at the start, the next process
/// reads it.
void Gateway::apply_change() {
  if (flow_.is_ending()) return;
  const bool was_unread = !parts_.store.unread().empty();
  auto loaded = parts_.store.load();
  if (was_unread || !parts_.store.unread().empty()) {
    host::log(host::Level::Warning, "restarting: the saved settings could not be read",
              {{"why", parts_.store.unread()}});
    return make_way();
  }
  const auto done = loaded ? take_over(std::move(*loaded)) : std::unexpected(std::move(loaded.error()));
  if (!done) revert(done.error());
  api_.on_changed();
}

/// An error: unchanged, but sockets may be closed.
std::expected<void, std::string> Gateway::take_over(admin::Store::LoadedSettings next) {
  settings::Settings in_use = settings::effective_settings(next.settings);
  settings::Restarts restarts = settings::restarts_by(settings_, in_use);
  if (restarts.listeners) {
    ADIT_TRY(listen(in_use.team));
  }
  const forward::Tokens before = tokens();
  settings_ = std::move(in_use);
  parts_.loaded = std::move(next);
  parts_.trouble.clear();
  const forward::Tokens now = tokens();
  restarts.scoring = restarts.scoring || !icd::same(before.scoring, now.scoring);
  restarts.mapping = restarts.mapping || !icd::same(before.mapping, now.mapping);
  log_settings(restarts, now);
  parts_.store.settle(parts_.loaded.settings);
  parts_.sockets.settle();
  return {};
}

void Gateway::log_settings(const settings::Restarts& restarts, const forward::Tokens& tokens) {
  flow_.on_settings_changed(restarts, tokens);
  overview_.on_settings_changed(restarts);
  routes_.serve_with(icd_options());
  api_.set_tokens(tokens.all, redaction());
  host::keep_out_of_log(redaction());
  guesses_.forget();
  links_.watch_settings(settings_);
  box_.set_settings(settings::file_of(parts_.loaded.settings));
  if (restarts.panel && !parts_.board.panel) reopen_panel();
  setup_.set_running(parts_.loaded, parts_.trouble);
  self_test_.on_settings_changed();
}

/// A line has one holder, so the old ones are released first.
void Gateway::reopen_panel() {
  lights_.release_lines();
  button_.release_line();
  auto panel =
      box::open_panel(settings_.panel, {.socket = parts_.options.panel, .folder = parts_.runtime_folder});
  lights_.set_lines(std::move(panel.lines));
  button_.set_line(std::move(panel.button));
}

/// The earlier settings stay in use. If their sockets fail, the process restarts.
void Gateway::revert(const std::string& why) {
  const bool is_back = parts_.store.revert();
  parts_.trouble = (is_back ? "the last change was reverted: " : "the last change cannot be used: ") + why;
  host::log(host::Level::Error,
            is_back ? "the last change of the settings was reverted" : "the last change cannot be used",
            {{"why", why}});
  setup_.set_running(parts_.loaded, parts_.trouble);
  if (auto listening = listen(settings_.team); !listening) return make_way();
  parts_.sockets.settle();
}

icd::Checked<std::string> Gateway::begin_ledger() {
  using enum icd::Status;
  if (!parts_.ledger.is_closed())
    return icd::refuse(Conflict, "the ledger can be read; aditd begins no other");
  auto kept_as = ledger::Ledger::set_aside(parts_.options.state);
  if (!kept_as) return icd::refuse(ServiceUnavailable, kept_as.error().what);
  host::log(host::Level::Warning, "restarting with another ledger", {{"kept_as", *kept_as}});
  make_way();
  return *std::move(kept_as);
}

}  // namespace adit::gateway
