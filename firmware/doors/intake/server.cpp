#include "intake/server.hpp"

#include <microhttpd.h>
#include <sys/epoll.h>
#include <sys/socket.h>

#include <algorithm>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "icd/try.hpp"
#include "intake/client.hpp"
#include "intake/head.hpp"
#include "intake/listen_socket.hpp"
#include "intake/proxy_listener.hpp"
#include "intake/request.hpp"
#include "intake/shares.hpp"
#include "intake/turnstile.hpp"
#include "loop/guard.hpp"

namespace adit::intake {
namespace {

/// libmicrohttpd's memory for one connection; a piece of a body gets about half. It is cleared for each
/// request, so more memory would push small requests out of the processor's caches.
constexpr std::size_t kConnectionMemory = 32 * 1024;

/// Runs of libmicrohttpd per turn of the loop. A run reads little of each body, and a turn costs as much.
constexpr int kReads = 4;

/// Connections that gave way and that libmicrohttpd has not ended yet. It accepts at most eleven at once.
constexpr unsigned kOnTheirWayOut = 32;

class MhdServer final : public Server, public Engine {
 public:
  MhdServer(loop::Loop& loop, Listen listen, Handler& handler)
      : loop_(loop),
        listen_(std::move(listen)),
        shares_(Shares::split(listen_.connections, listen_.connections_per_address)),
        turnstile_(loop, handler, listen_.guesses == nullptr ? own_guesses_ : *listen_.guesses, listen_.late,
                   [this](CloseReason why, const std::string& address) { on_closed(why, address); }) {}
  MhdServer(const MhdServer&) = delete;
  MhdServer& operator=(const MhdServer&) = delete;
  ~MhdServer() override;

  std::expected<void, std::string> start(loop::FileDescriptor given);
  void stop_listening() override;
  std::uint16_t port() const override { return port_; }
  std::size_t connections() const override { return clients_.size(); }
  std::size_t unauthenticated_connections() const override;

  loop::Instant now() const override { return loop_.now(); }
  const Listen& listen() const override { return listen_; }
  void schedule_run() override;
  void schedule_check(loop::Instant when) override;
  void on_closed(CloseReason why, const std::string& address) override {
    if (listen_.on_ended) listen_.on_ended(why, address);
  }
  void schedule_hold_back(std::uint64_t number) override { to_hold_back_.push_back(number); }
  void begin_request(Client& client) override;

 private:
  static MHD_Result request_came(void* cls, MHD_Connection* connection, const char* url, const char* method,
                                 const char* version, const char* upload, std::size_t* upload_size,
                                 void** request_cls);
  static void request_completed(void* cls, MHD_Connection* connection, void** request_cls,
                                MHD_RequestTerminationCode why);
  static void on_connection_change(void* cls, MHD_Connection* connection, void** client_cls,
                                   MHD_ConnectionNotificationCode what);
  /// parse_target() decodes targets, so libmicrohttpd must not.
  static std::size_t leave_escaped(void*, MHD_Connection*, char* text) {
    return std::char_traits<char>::length(text);
  }
  static void discard_log(void*, const char*, va_list) {}

  ConnectionAction serve_request(Client& client, std::string_view upload, void** request_cls);
  /// Gives libmicrohttpd a connection that stunnel passed on.
  void add(loop::FileDescriptor connection, ProxyHeader header);
  void on_connected(MHD_Connection* connection, void** client_cls);
  std::vector<ConnectionInfo> held_connections(const Client* one) const;
  /// Closes unauthenticated connections above their share.
  void close_unauthenticated();
  /// For a request with a right token. False: refuse the request.
  bool make_room_for(Client& client);
  void run();
  void pause_clients();
  void check_deadlines();

  loop::Loop& loop_;
  const Listen listen_;
  const Shares shares_;
  TokenGuesses own_guesses_;
  Turnstile turnstile_;
  MHD_Daemon* daemon_ = nullptr;
  std::uint16_t port_ = 0;
  bool stopping_ = false;
  bool listening_ = false;
  bool run_is_due_ = false;
  std::map<std::uint64_t, std::unique_ptr<Client>> clients_;  // by Client::number(): oldest first
  std::vector<std::uint64_t> to_hold_back_;                   // numbers of clients
  std::shared_ptr<void> accepts_;
  std::optional<ProxyListener> proxied_;
  std::map<int, Client::Addresses> proxied_from_;  // by socket; libmicrohttpd 1 begins the connection later
  loop::Instant look_due_ = loop::Instant::max();
  loop::Source readable_, deadline_timer_;
  const std::shared_ptr<MhdServer*> alive_ = std::make_shared<MhdServer*>(this);  // for posted tasks
};

std::expected<void, std::string> MhdServer::start(loop::FileDescriptor given) {
  auto socket = ADIT_TRY(given ? std::expected<loop::FileDescriptor, std::string>(std::move(given))
                               : open_listen_socket(listen_));
  port_ = port_of(socket.get());
  // ProxyListener accepts connections by TLS. libmicrohttpd cannot read a PROXY header.
  const bool by_tls = listen_.by_tls;
  const unsigned flags = MHD_USE_EPOLL | MHD_ALLOW_SUSPEND_RESUME | MHD_USE_ERROR_LOG;
  daemon_ = MHD_start_daemon(
      by_tls ? flags | MHD_USE_NO_LISTEN_SOCKET : flags, 0, nullptr, nullptr, &MhdServer::request_came, this,
      MHD_OPTION_EXTERNAL_LOGGER, &MhdServer::discard_log, nullptr, MHD_OPTION_CONNECTION_LIMIT,
      shares_.unauthenticated + shares_.known + kOnTheirWayOut, MHD_OPTION_CONNECTION_TIMEOUT, 0u,
      MHD_OPTION_CONNECTION_MEMORY_LIMIT, kConnectionMemory, MHD_OPTION_NOTIFY_CONNECTION,
      &MhdServer::on_connection_change, this, MHD_OPTION_NOTIFY_COMPLETED, &MhdServer::request_completed,
      this, MHD_OPTION_UNESCAPE_CALLBACK, &MhdServer::leave_escaped, nullptr,
      by_tls ? MHD_OPTION_END : MHD_OPTION_LISTEN_SOCKET, socket.get(), MHD_OPTION_END);
  if (daemon_ == nullptr) return std::unexpected("the HTTP server did not start");
  if (by_tls) {
    proxied_.emplace(loop_, std::move(socket), listen_.unauthenticated_within,
                     [this](loop::FileDescriptor connection, ProxyHeader header) {
                       add(std::move(connection), std::move(header));
                     });
  } else {
    accepts_ = accept_instead(socket.get(), [this](int fd, const sockaddr* peer, unsigned size) {
      MHD_add_connection(daemon_, fd, peer, size);
      pause_clients();
    });
    socket.release();  // NOLINT(bugprone-unused-return-value): libmicrohttpd's, until stop_listening()
  }
  listening_ = true;

  const MHD_DaemonInfo* info = MHD_get_daemon_info(daemon_, MHD_DAEMON_INFO_EPOLL_FD);
  if (info == nullptr || info->epoll_fd < 0)
    return std::unexpected("the HTTP server has no epoll descriptor");
  deadline_timer_ = loop_.timer([this] { check_deadlines(); });
  readable_ = loop_.watch(info->epoll_fd, EPOLLIN, [this](std::uint32_t) { run(); });
  return {};
}

MhdServer::~MhdServer() {
  if (daemon_ == nullptr) return;
  stopping_ = true;
  readable_ = {};
  stop_listening();
  for (const auto& [number, client] : clients_) client->cut();  // libmicrohttpd aborts if one is suspended
  MHD_stop_daemon(daemon_);
}

/// Closes the socket without shutdown(), because that of libmicrohttpd would also stop copies of it.
void MhdServer::stop_listening() {
  if (!std::exchange(listening_, false)) return;
  accepts_.reset();
  proxied_.reset();
  const MHD_socket socket = MHD_quiesce_daemon(daemon_);
  if (socket != MHD_INVALID_SOCKET) ::close(socket);
}

void MhdServer::add(loop::FileDescriptor connection, ProxyHeader header) {
  const int fd = connection.get();
  proxied_from_.insert_or_assign(
      fd, Client::Addresses{std::move(header.peer), std::move(header.local), header.size});
  sockaddr_storage peer{};  // of stunnel
  socklen_t size = sizeof peer;
  ::getpeername(fd, reinterpret_cast<sockaddr*>(&peer), &size);
  MHD_add_connection(daemon_, connection.release(), reinterpret_cast<const sockaddr*>(&peer), size);
  pause_clients();
  schedule_run();
}

void MhdServer::schedule_run() {
  if (stopping_ || std::exchange(run_is_due_, true)) return;
  // A timer would be late by the accuracy of the loop's timers.
  loop_.post([weak = std::weak_ptr(alive_)] {
    if (const auto alive = weak.lock(); alive && (*alive)->run_is_due_) (*alive)->run();
  });
}

void MhdServer::run() {
  run_is_due_ = false;
  bool has_more = true;
  for (int left = kReads; has_more && left > 0; --left) {
    MHD_run(daemon_);
    pause_clients();
    MHD_UNSIGNED_LONG_LONG wait_ms = 0;
    has_more = MHD_get_timeout(daemon_, &wait_ms) == MHD_YES && wait_ms == 0;
  }
  if (has_more) schedule_run();
  close_unauthenticated();
}

/// For connections that libmicrohttpd has added or answered. It has not read from them since.
void MhdServer::pause_clients() {
  for (const std::uint64_t number : std::exchange(to_hold_back_, {})) {
    if (const auto found = clients_.find(number); found != clients_.end()) found->second->pause_reading();
  }
}

void MhdServer::schedule_check(loop::Instant when) {
  if (stopping_ || when >= look_due_) return;
  look_due_ = when;
  deadline_timer_.call_at(when);
}

void MhdServer::check_deadlines() {
  look_due_ = loop::Instant::max();
  const loop::Instant now = loop_.now();
  for (const auto& [number, client] : clients_) {
    if (client->deadline().at() <= now) client->on_late();
  }
  loop::Instant next = loop::Instant::max();
  for (const auto& [number, client] : clients_) next = std::min(next, client->deadline().at());
  if (next != loop::Instant::max()) schedule_check(next);
}

void MhdServer::on_connected(MHD_Connection* connection, void** client_cls) {
  // libmicrohttpd 1 overwrites the answer at the next question.
  const sockaddr* const address =
      MHD_get_connection_info(connection, MHD_CONNECTION_INFO_CLIENT_ADDRESS)->client_addr;
  const int socket = MHD_get_connection_info(connection, MHD_CONNECTION_INFO_CONNECTION_FD)->connect_fd;
  auto proxied = proxied_from_.extract(socket);
  auto client =
      std::make_unique<Client>(*this, loop_, connection, socket,
                               proxied ? std::move(proxied.mapped())
                                       : Client::Addresses{address_text(address), local_address(socket)});
  Client* const known = client.get();
  clients_.emplace(known->number(), std::move(client));
  *client_cls = known;
  schedule_hold_back(known->number());
}

std::size_t MhdServer::unauthenticated_connections() const {
  return static_cast<std::size_t>(std::ranges::count_if(
      clients_, [](const auto& each) { return !each.second->deadline().is_authenticated(); }));
}

std::vector<ConnectionInfo> MhdServer::held_connections(const Client* one) const {
  std::vector<ConnectionInfo> all;
  for (const auto& [number, client] : clients_) {
    if (client.get() == one) continue;
    if (const auto held = client->held_share()) all.push_back(*held);
  }
  return all;
}

void MhdServer::close_unauthenticated() {
  if (unauthenticated_connections() <= shares_.unauthenticated) return;
  while (const auto number = unauthenticated_to_close(held_connections(nullptr), shares_))
    clients_.at(*number)->give_way();
}

bool MhdServer::make_room_for(Client& client) {
  const Room room = room_for(client.peer(), held_connections(&client), shares_);
  if (room.gives_way) clients_.at(*room.gives_way)->give_way();
  return room.is_there;
}

void MhdServer::begin_request(Client& client) {
  std::string head = client.gate().take_head_text();
  const HeadParts parts = parts_of(head);
  auto request = std::make_shared<Request>(client, parts.method);
  client.request_begun(request);
  auto target = parse_target(parts.target);
  if (!target) {
    request->refuse_head("request target: expected a path of UTF-8, percent-encoded");
  } else {
    request->begin(std::move(head), std::move(*target), client.gate().framing());
    const Credentials shown = turnstile_.read_credentials(request->head());
    const bool known = shown == Credentials::Token || shown == Credentials::Enough;
    const bool has_room = !known || client.deadline().is_authenticated() || make_room_for(client);
    client.deadline().set_authenticated(known && has_room);
    if (has_room) return request->open(turnstile_);
    on_closed(CloseReason::NoRoom, client.peer());
    request->refuse_for_room("too many requests at once, from this address or in total; try again");
  }
}

Client* client_of(MHD_Connection* connection) {
  const auto* info = MHD_get_connection_info(connection, MHD_CONNECTION_INFO_SOCKET_CONTEXT);
  return info == nullptr ? nullptr : static_cast<Client*>(info->socket_context);
}

MHD_Result MhdServer::request_came(void* cls, MHD_Connection* connection, const char*, const char*,
                                   const char*, const char* upload, std::size_t* upload_size,
                                   void** request_cls) {
  auto& server = *static_cast<MhdServer*>(cls);
  Client* client = client_of(connection);
  if (client == nullptr || server.stopping_) return MHD_NO;
  const std::string_view piece(upload, std::exchange(*upload_size, 0));
  const ConnectionAction next =
      client->run_guarded([&] { return server.serve_request(*client, piece, request_cls); });
  return next == ConnectionAction::Close ? MHD_NO : MHD_YES;
}

ConnectionAction MhdServer::serve_request(Client& client, std::string_view upload, void** request_cls) {
  if (*request_cls == nullptr) {
    if (!client.gate().admit_request()) return ConnectionAction::Close;
    *request_cls = &client;
    begin_request(client);
    return ConnectionAction::KeepOpen;
  }
  if (upload.empty()) return client.request()->end();
  return client.request()->body({reinterpret_cast<const std::uint8_t*>(upload.data()), upload.size()});
}

void MhdServer::request_completed(void*, MHD_Connection* connection, void** request_cls,
                                  MHD_RequestTerminationCode why) {
  Client* client = client_of(connection);
  if (*request_cls == nullptr || client == nullptr || !client->request()) return;
  *request_cls = nullptr;
  const std::shared_ptr<Request> request = client->request();
  loop::run_guarded("the end of a request",
                    [&] { client->on_request_end(why == MHD_REQUEST_TERMINATED_COMPLETED_OK); });
  loop::run_guarded("the end of a request", [&] { request->on_completed(); });
}

void MhdServer::on_connection_change(void* cls, MHD_Connection* connection, void** client_cls,
                                     MHD_ConnectionNotificationCode what) {
  auto& server = *static_cast<MhdServer*>(cls);
  if (what == MHD_CONNECTION_NOTIFY_STARTED) {
    loop::run_guarded("a connection of the team", [&] { server.on_connected(connection, client_cls); });
  } else if (auto* client = static_cast<Client*>(std::exchange(*client_cls, nullptr)); client != nullptr) {
    loop::run_guarded("a connection of the team", [&] {
      // Of a request that libmicrohttpd does not know.
      if (const std::shared_ptr<Request> request = client->request()) request->on_completed();
      server.clients_.erase(client->number());
      server.schedule_run();  // libmicrohttpd checks only then if there is room for another connection
    });
  }
}

}  // namespace

std::expected<std::unique_ptr<Server>, std::string> Server::start(loop::Loop& loop, const Listen& listen,
                                                                  Handler& handler,
                                                                  loop::FileDescriptor socket) {
  auto server = std::make_unique<MhdServer>(loop, listen, handler);
  ADIT_TRY(server->start(std::move(socket)));
  return server;
}

}  // namespace adit::intake
