#include "cli/ask.hpp"

#include <arpa/inet.h>
#include <netdb.h>
#include <netinet/in.h>
#include <poll.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <system_error>
#include <utility>

#include "cli/contexts.hpp"
#include "codec/json.hpp"
#include "host/interfaces.hpp"
#include "host/log.hpp"
#include "host/service.hpp"
#include "icd/sentence.hpp"
#include "icd/text.hpp"
#include "icd/try.hpp"
#include "uplink/socket.hpp"

namespace adit::cli {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kOk = 200, kAccepted = 202;

std::string reason(int error) {
  return std::system_category().message(error);
}

/// 0 or errno; ETIMEDOUT at the deadline.
int wait_for(int fd, short events, Clock::time_point deadline) {
  while (true) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now()).count();
    if (left <= 0) return ETIMEDOUT;
    pollfd entry{fd, events, 0};
    const int ready = poll(&entry, 1, static_cast<int>(left));
    if (ready > 0) return 0;
    if (ready < 0 && errno != EINTR) return errno;
  }
}

/// The whole answer, or an error.
std::expected<HttpReply, std::string> run_exchange(int fd, uplink::Exchange& exchange,
                                                   Clock::time_point deadline) {
  while (true) {
    if (exchange.wants_to_write())
      exchange.write(fd);  // after a write error, the peer's answer may still tell the reason
    switch (exchange.read(fd)) {
      case uplink::Exchange::Answer::Whole:
        return exchange.take_answer();
      case uplink::Exchange::Answer::Lost:
        return std::unexpected(exchange.doubt().why);
      case uplink::Exchange::Answer::Waiting:
        break;
    }
    const short events = exchange.wants_to_write() ? POLLIN | POLLOUT : POLLIN;
    const auto until =
        exchange.is_early() ? std::min(deadline, Clock::now() + uplink::Exchange::kLook) : deadline;
    const int error = wait_for(fd, events, until);
    if (error != 0 && (error != ETIMEDOUT || Clock::now() >= deadline)) return std::unexpected(reason(error));
  }
}

uplink::Endpoint endpoint_of(const settings::Address& address) {
  return {.address = address.address, .port = address.port, .interface = ""};
}

std::expected<loop::FileDescriptor, std::string> connect_to(const uplink::Endpoint& endpoint,
                                                            Clock::time_point deadline) {
  auto fd = uplink::begin_connect(endpoint);
  if (!fd) return std::unexpected(fd.error().why);
  int error = wait_for(fd->get(), POLLOUT, deadline);
  if (error == 0) error = uplink::connect_error(fd->get());
  if (error != 0) return std::unexpected(reason(error));
  return *std::move(fd);
}

std::string unreachable_text(const settings::Address& address, const std::string& why) {
  return "cannot reach Adit at " + to_text(address) + ": " + why;
}

}  // namespace

uplink::Request get_request(std::string target) {
  return {.method = "GET",
          .target = std::move(target),
          .content_type = "",
          .body = {},
          .longest_answer = kLargestBody};
}

uplink::Request post_request(Post action) {
  const auto body = std::make_shared<const std::string>(std::move(action.body));
  uplink::Request request = get_request(std::move(action.target));
  request.method = "POST";
  request.content_type = std::move(action.content_type);
  request.body.append(body, {reinterpret_cast<const std::uint8_t*>(body->data()), body->size()});
  return request;
}

std::expected<HttpReply, NoReply> http_ask(const settings::Address& address, const icd::BearerToken& token,
                                           uplink::Request request, std::chrono::milliseconds within) {
  const auto deadline = Clock::now() + within;
  const uplink::Endpoint endpoint = endpoint_of(address);
  const auto fd = connect_to(endpoint, deadline);
  if (!fd) return std::unexpected(NoReply{unreachable_text(address, fd.error()), false});
  uplink::Exchange exchange(endpoint, token, std::move(request));
  auto reply = run_exchange(fd->get(), exchange, deadline);
  if (!reply) return std::unexpected(NoReply{unreachable_text(address, reply.error()), true});
  return std::move(*reply);
}

std::expected<std::unique_ptr<HttpStream>, std::string> HttpStream::ask(const settings::Address& address,
                                                                        const icd::BearerToken& token,
                                                                        uplink::Request request,
                                                                        std::chrono::milliseconds within) {
  const auto deadline = Clock::now() + within;
  const uplink::Endpoint endpoint = endpoint_of(address);
  auto fd = connect_to(endpoint, deadline);
  if (!fd) return std::unexpected(unreachable_text(address, fd.error()));
  auto stream = std::make_unique<HttpStream>(*std::move(fd), endpoint, token, std::move(request));
  while (stream->exchange_.wants_to_write()) {
    if (stream->exchange_.write(stream->fd()) != 0) break;  // read() returns the reason
    if (!stream->exchange_.wants_to_write()) break;
    if (const int error = wait_for(stream->fd(), POLLOUT, deadline); error != 0) {
      return std::unexpected(unreachable_text(address, reason(error)));
    }
  }
  return stream;
}

HttpStream::HttpStream(loop::FileDescriptor fd, const uplink::Endpoint& endpoint,
                       const icd::BearerToken& token, uplink::Request request)
    : fd_(std::move(fd)), exchange_(endpoint, token, std::move(request)) {}

std::expected<std::string, HttpStream::StreamEnd> HttpStream::read() {
  if (!ended_) read_exchange();
  std::string came = exchange_.status() == kOk ? exchange_.take_part() : "";
  if (ended_ && came.empty()) return std::unexpected(*ended_);
  return came;
}

void HttpStream::read_exchange() {
  const auto answer = exchange_.read(fd());
  if (answer == uplink::Exchange::Answer::Lost) ended_ = {.why = exchange_.doubt().why};
  if (answer == uplink::Exchange::Answer::Whole) {
    ended_ = {.status = exchange_.status() == kOk ? 0 : exchange_.status(), .why = "closed by the server"};
  }
}

namespace {

constexpr std::uint16_t kPortOfUrls = 80;  // RFC 9110 4.2.1

bool is_ipv6(const std::string& address) {
  return address.find(':') != std::string::npos;
}

bool is_any(const std::string& address) {
  in6_addr parsed{};
  if (!is_ipv6(address)) return address == "0.0.0.0";
  return inet_pton(AF_INET6, address.c_str(), &parsed) == 1 && IN6_IS_ADDR_UNSPECIFIED(&parsed);
}

bool is_numeric(const std::string& address) {
  in6_addr parsed{};
  return inet_pton(is_ipv6(address) ? AF_INET6 : AF_INET, address.c_str(), &parsed) == 1;
}

/// fe80::/10. A connection to such an address needs its interface.
bool is_link_local(std::string_view address) {
  return address.starts_with("fe") && address.find(':') == 4 && std::string_view("89ab").contains(address[2]);
}

/// The interface's first address that a listener at `any` accepts.
std::expected<std::string, std::string> address_of(const std::string& interface, const std::string& any) {
  const auto all = ADIT_TRY(host::interfaces());
  for (const host::Interface& each : all) {
    for (std::string_view address : each.addresses) {
      std::string text(icd::cut(address, '/'));
      if (each.name == interface && is_ipv6(text) == is_ipv6(any) && !is_link_local(text)) return text;
    }
  }
  return std::unexpected("interface " + interface + " (team.interface) has no address");
}

/// The option's value, or else the environment variable's, or "".
std::string option_or_environment(const std::string& option, const char* name) {
  return option.empty() ? variable(name) : option;
}

std::expected<settings::Address, std::string> address_in(const std::string& file, const std::string& advice) {
  const auto text = host::read_file(file);
  if (!text) return std::unexpected(text.error() + "; " + advice + "give Adit's address by --at ADDR[:PORT]");
  const auto settings = settings::parse(*text);
  if (!settings) {
    return std::unexpected(file + ": " + settings.error().front().sentence() + " (see adit check)");
  }
  return reach(settings->team);
}

/// The address of the host. IPv4 first, because link-local addresses of IPv6 need an interface.
std::expected<settings::Address, std::string> resolve(const settings::Address& address) {
  if (is_numeric(address.address)) return address;
  std::string why;
  for (const int family : {AF_INET, AF_INET6}) {
    addrinfo wanted{};
    wanted.ai_family = family;
    wanted.ai_socktype = SOCK_STREAM;
    addrinfo* found = nullptr;
    const int error = getaddrinfo(address.address.c_str(), nullptr, &wanted, &found);
    const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> all(found, &freeaddrinfo);
    char text[NI_MAXHOST];
    if (error == 0 &&
        getnameinfo(found->ai_addr, found->ai_addrlen, text, sizeof text, nullptr, 0, NI_NUMERICHOST) == 0)
      return settings::Address{text, address.port};
    if (why.empty()) why = gai_strerror(error);
  }
  return std::unexpected("cannot find the host " + address.address + ": " + why);
}

/// How the options name Adit.
struct AditLocation {
  std::string at = {};      // "": by the settings
  const char* source = "";  // "--at" or "ADIT_AT", for errors
  std::optional<Context> context = {};
};

std::expected<AditLocation, std::string> named_by(const Options& options) {
  const bool file_named = options.settings != kGivenSettings;
  const std::string at = file_named ? options.at : option_or_environment(options.at, "ADIT_AT");
  if (at.empty() && file_named) return AditLocation{};
  const auto contexts = ADIT_TRY(load_contexts(contexts_file()));
  const Context* const context = contexts.find(at.empty() ? contexts.current : at);
  if (context != nullptr) return AditLocation{.at = context->at, .context = *context};
  return AditLocation{.at = at, .source = options.at.empty() ? "ADIT_AT: " : "--at: "};
}

std::expected<settings::Address, std::string> address_of(const Options& options, const AditLocation& named) {
  if (!named.at.empty()) {
    const auto address = parse_location(named.at);
    if (!address) return std::unexpected(named.source + address.error());
    return resolve(*address);
  }
  const bool file_named = options.settings != kGivenSettings;
  const bool is_saved = !file_named && host::can_exist(options.saved_settings);
  return is_saved ? address_in(options.saved_settings, "run adit as root, or ")
                  : address_in(options.settings, "");
}

Result<Token> token_of(const Options& options, const Console& console, const AditLocation& named) {
  const std::string file = option_or_environment(options.token_file, "ADIT_TOKEN_FILE"),
                    text = variable("ADIT_TOKEN");
  if (file == "-") return Token{ADIT_TRY(read_token(console, "token: ")), "the input"};
  if (file.empty() && (!text.empty() || named.context)) {
    auto token = icd::BearerToken::parse(text.empty() ? named.context->token : text);
    const std::string source = text.empty() ? "context " + named.context->name : "ADIT_TOKEN";
    if (!token) return to_failure(source + ": expected a token of 1 to 256 visible ASCII characters");
    return Token{*std::move(token), source};
  }
  const std::vector<std::string> folders = {options.saved_secrets, options.secrets};
  auto token = find_token(file, folders);
  if (!token) return to_failure(token.error());
  if (*token) return std::move(**token);
  return to_failure("cannot read a token in " + options.saved_secrets + " or " + options.secrets +
                    ": set the team's token on the page, run adit as root, name a token file by --token-file "
                    "FILE, or save the token once by adit login");
}

/// For an answer other than 200.
Failure failure_of(const Adit& adit, const HttpReply& reply) {
  if (reply.status == 401)
    return {Exit::Unable, "Adit rejects the token in " + adit.token.file, reply.status};
  const std::string sentence = sentence_in(reply.body);
  if (sentence.empty())
    return {Exit::Unable,
            "the server at " + to_text(adit.address) + " is not Adit, or is another version (HTTP status " +
                std::to_string(reply.status) + ")",
            reply.status};
  const bool decided =
      reply.status == 404 || reply.status == 409 || reply.status == 413 || reply.status == 422;
  return {decided ? Exit::Attention : Exit::Unable, sentence, reply.status};
}

Result<std::string> body_of(const Adit& adit, std::expected<HttpReply, NoReply> reply,
                            const std::string& if_sent) {
  if (!reply) return to_failure(reply.error().sentence + (reply.error().sent ? if_sent : ""));
  if (reply->status != kOk && reply->status != kAccepted) return std::unexpected(failure_of(adit, *reply));
  return std::move(reply->body);
}

std::unexpected<Failure> unreadable_answer(const Adit& adit, const std::string& why) {
  return to_failure("cannot read the answer of Adit at " + to_text(adit.address) + ": " + why);
}

}  // namespace

std::expected<settings::Address, std::string> parse_address(std::string_view text, std::uint16_t usual) {
  const bool has_port = !text.ends_with(']') && text.contains(':');
  const std::size_t colon = has_port ? text.rfind(':') : text.size();
  std::string_view host = text.substr(0, colon);
  const bool bracketed = host.starts_with('[') && host.ends_with(']');
  if (bracketed) host = host.substr(1, host.size() - 2);
  const std::string address(host);
  const auto port = has_port ? icd::number_in<std::uint16_t>(text.substr(colon + 1)) : std::optional(usual);
  if (port.value_or(0) != 0 && is_numeric(address) && is_ipv6(address) == bracketed)
    return settings::Address{address, *port};
  return std::unexpected("expected an address, as 10.0.0.1, 10.0.0.1:8000 or [fd00::1]:8000, got '" +
                         std::string(text) + "'");
}

std::expected<settings::Address, std::string> parse_location(std::string_view text) {
  constexpr std::string_view kScheme = "http://";
  if (text.starts_with("https://"))
    return std::unexpected(
        icd::sentence("adit uses no TLS: expected http:// instead of https://, got '", text, "'"));
  std::string_view authority = text;
  const bool is_url = text.starts_with(kScheme);
  if (is_url) authority.remove_prefix(kScheme.size());
  if (is_url) authority = icd::cut(authority, '/');
  const std::uint16_t usual = is_url ? kPortOfUrls : kUsualPort;
  if (const auto address = parse_address(authority, usual)) return address;
  std::string_view rest = authority;
  const std::string_view host = icd::cut(rest, ':');
  const bool has_port = host.size() < authority.size();
  const auto port = has_port ? icd::number_in<std::uint16_t>(rest) : std::optional(usual);
  constexpr std::string_view kOthers = "-._";
  const bool is_name =
      !host.empty() && host.size() < 254 &&
      std::ranges::any_of(
          host, [](char c) { return icd::is_letter_or_digit(c) && !icd::is_digit(c); }) &&
      std::ranges::all_of(host, [&](char c) { return icd::is_letter_or_digit(c) || kOthers.contains(c); });
  if (is_name && port.value_or(0) != 0) return settings::Address{std::string(host), *port};
  return std::unexpected(
      "expected an address, a name or a URL, as 10.0.0.1, adit.local:8000 or "
      "http://10.0.0.1:8000, got '" +
      std::string(text) + "'");
}

std::string to_text(const settings::Address& address) {
  return uplink::authority_of(endpoint_of(address));
}

std::expected<settings::Address, std::string> reach(const settings::Team& team) {
  settings::Address address = team.listen.front();
  if (address.port == 0)
    return std::unexpected("team.listen[0].port is 0 (any free port): give Adit's address by --at ADDR:PORT");
  if (!is_any(address.address)) return address;
  if (team.interface.empty()) {
    address.address = is_ipv6(address.address) ? "::1" : "127.0.0.1";
    return address;
  }
  address.address = ADIT_TRY(address_of(team.interface, address.address));
  return address;
}

std::unexpected<Failure> to_failure(std::string sentence, Exit exit) {
  return std::unexpected(Failure{exit, std::move(sentence)});
}

Result<icd::BearerToken> read_token(const Console& console, const std::string& question) {
  const auto text = console.read_secret(question);
  if (!text) return to_failure("no token was given: type it at a terminal, or pipe it into adit");
  auto token = icd::BearerToken::parse(icd::trim(*text));
  if (!token) return to_failure("expected a token of 1 to 256 visible ASCII characters");
  return *std::move(token);
}

Result<Adit> adit_of(const Options& options, const Console& console) {
  const auto named = named_by(options);
  if (!named) return to_failure(named.error());
  const auto address = address_of(options, *named);
  if (!address) return to_failure(address.error());
  return Adit{*address, ADIT_TRY(token_of(options, console, *named))};
}

Result<std::string> get(const Adit& adit, const std::string& target, std::chrono::milliseconds within) {
  return body_of(adit, http_ask(adit.address, adit.token.token, get_request(target), within), "");
}

Result<std::string> post(const Adit& adit, Post action) {
  const std::string if_sent = "; the action may have been done: see " + action.check;
  const auto within = action.within;
  return body_of(adit, http_ask(adit.address, adit.token.token, post_request(std::move(action)), within),
                 if_sent);
}

std::string sentence_in(const std::string& body) {
  const auto value = codec::parse_json(body);
  const auto* sentence = value ? std::get_if<std::string>(&value->is) : nullptr;
  return sentence == nullptr ? "" : *sentence;
}

Result<void> read_into(const Adit& adit, const Result<codec::Value>& answer, const codec::RowKind& kind,
                       void* row) {
  if (!answer) return std::unexpected(answer.error());
  codec::Reading reading;
  kind.read(codec::Field(*answer, reading), row);
  if (const auto outcome = reading.outcome(true); !outcome)
    return unreadable_answer(adit, "it is another version: " + outcome.error().sentence);
  return {};
}

Result<codec::Value> json_in(const Adit& adit, std::string_view body) {
  auto value = codec::parse_json(body);
  if (!value) return unreadable_answer(adit, "its answer is not JSON: " + value.error());
  return *std::move(value);
}

Outcome print_result(const Call& call, const std::string& json, const std::string& text, Exit exit) {
  return {exit, call.options.json ? json + '\n' : text, ""};
}

Result<Outcome> act(const Call& call, Post action, const std::string& done) {
  const auto answer = ADIT_TRY(post(call.adit, std::move(action)));
  return print_result(call, answer, done);
}

Outcome act_on_each(const Call& call, const std::function<Result<Outcome>(std::int64_t number)>& act_on) {
  Outcome all;
  for (const std::int64_t number : call.options.numbers) {
    const auto one = act_on(number);
    const Outcome outcome = one ? *one : failure_outcome(one.error());
    all.exit = std::max(all.exit, outcome.exit);
    all.out += outcome.out;
    all.err += outcome.err;
    if (outcome.exit == Exit::Unable) break;
  }
  return all;
}

Result<void> confirm(const Options& options, const Console& console, const std::string& why,
                     const std::string& question, const std::string& undone) {
  if (options.yes) return {};
  const auto meant = console.ask(host::escape(why) + '\n' + question);
  if (!meant) return to_failure(why + " It was not done; to do it, add --yes", Exit::Attention);
  if (!*meant) return to_failure(undone, Exit::Attention);
  return {};
}

Result<void> write_to(const std::string& file, const std::string& content) {
  std::ofstream stream(file, std::ios::binary);
  if (!stream || !(stream << content).flush()) return to_failure(file + ": cannot be written");
  return {};
}

Outcome failure_outcome(const Failure& failure) {
  return {failure.exit, "", "adit: " + host::escape(failure.sentence) + '\n'};
}

}  // namespace adit::cli
