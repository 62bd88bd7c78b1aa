#pragma once

#include <new>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "intake/icd_routes.hpp"
#include "intake/message_handler.hpp"
#include "intake/not_found.hpp"
#include "intake/raw_client.hpp"
#include "intake/served.hpp"
#include "loop/workers.hpp"

namespace adit::intake {

inline constexpr std::string_view kToken = "flux230{showroom";
inline constexpr std::string_view kOtherToken = "the-posts-own-token";

/// Keeps accepted messages. Use its members on the loop's thread.
class FakeMessageHandler final : public MessageHandler {
 public:
  std::vector<icd::MapUpdate> maps;
  std::vector<icd::StateUpdate> states;
  std::vector<icd::MarkersUpdate> markers;
  std::vector<icd::ArtifactReport> reports;
  std::vector<std::string> left_out_of_reports;
  std::vector<Sender> senders;
  std::vector<std::shared_ptr<Responder>> responders;  // of reports and status
  std::vector<std::pair<icd::Uri, icd::Refusal>> refusals;
  std::optional<icd::Refusal> full;  // answer of accept()

  std::vector<std::function<void()>> storing;  // pending answers of maps and pieces, for the test to call
  bool stores_at_once = true;
  bool fails = false;  // accept() throws

  int arriving = 0;             // uploads in progress
  std::size_t stored = 0;       // all stored bytes of map data
  std::size_t room = 1u << 30;  // left for map data
  bool stores_pieces = true;    // otherwise they wait in `storing`

  std::shared_ptr<MapArrival> begin_map() override { return std::make_shared<Arrival>(*this); }
  icd::Checked<void> accept(icd::StateUpdate update, const Sender& sender) override {
    return keep(states, update, sender);
  }
  void accept(icd::MarkersUpdate update, const Sender& sender,
              std::function<void(icd::Checked<void>)> done) override {
    done(keep(markers, std::move(update), sender));
  }
  void accept(const icd::ArtifactReport& report, const Sender& sender,
              std::shared_ptr<Responder> responder) override {
    reports.push_back(report);
    senders.push_back(sender);
    responders.push_back(std::move(responder));
  }
  void status(const Sender& sender, std::shared_ptr<Responder> responder) override {
    senders.push_back(sender);
    responders.push_back(std::move(responder));
  }
  void record_dropped(icd::Uri /*uri*/, const Sender& /*sender*/, const std::string& why) override {
    left_out_of_reports.push_back(why);
  }
  void on_rejected(icd::Uri uri, const Sender& sender, const icd::Refusal& refusal) override {
    senders.push_back(sender);
    refusals.emplace_back(uri, refusal);
  }

 private:
  /// Stores map data in memory.
  class Arrival final : public MapArrival {
   public:
    explicit Arrival(FakeMessageHandler& message_handler) : message_handler_(message_handler) {
      ++message_handler_.arriving;
    }
    ~Arrival() override { --message_handler_.arriving; }
    Arrival(const Arrival&) = delete;
    Arrival& operator=(const Arrival&) = delete;

    void store(icd::ChunkedBytes bytes, std::function<void(icd::ChunkedBytes)> done) override {
      while (!bytes.empty() && bytes.chunks().front()->size() <= message_handler_.room) {
        const auto chunk = bytes.pop_front();
        message_handler_.room -= chunk->size();
        message_handler_.stored += chunk->size();
        stored_.append(*chunk);
      }
      if (message_handler_.stores_pieces) return done(std::move(bytes));
      message_handler_.storing.emplace_back([bytes, done = std::move(done)] { done(bytes); });
    }
    icd::Checked<icd::ChunkedBytes> stored_bytes() override { return stored_; }
    void accept(icd::MapUpdate update, const Sender& sender,
                std::function<void(icd::Checked<void>)> done) override {
      auto kept = message_handler_.keep(message_handler_.maps, std::move(update), sender);
      if (message_handler_.stores_at_once) return done(std::move(kept));
      message_handler_.storing.emplace_back([kept = std::move(kept), done = std::move(done)] { done(kept); });
    }

   private:
    FakeMessageHandler& message_handler_;
    icd::ChunkedBytes stored_;
  };

  template <class Message>
  icd::Checked<void> keep(std::vector<Message>& kept, Message message, const Sender& sender) {
    if (fails) throw std::bad_alloc();
    if (full) return std::unexpected(*full);
    kept.push_back(std::move(message));
    senders.push_back(sender);
    return {};
  }
};

/// The routes over a FakeMessageHandler on a loop, with one worker.
class Team {
 public:
  explicit Team(IcdOptions options = with_tokens()) : options_(std::move(options)) {}
  ~Team() {
    served.on_loop([this] { served.destroy_server(), front.routes = nullptr, front.workers = nullptr; });
  }
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;

  static IcdOptions with_tokens() {
    IcdOptions options;
    options.tokens = {*icd::BearerToken::parse(kToken), *icd::BearerToken::parse(kOtherToken)};
    return options;
  }

  /// Sends `text` on a new connection and returns the answer.
  std::optional<Reply> ask(const std::string& text,
                           std::chrono::milliseconds patience = std::chrono::seconds(10)) {
    RawClient client(served.port());
    client.send(text);
    return client.reply(patience);
  }

  /// Keeps the worker busy until end() or the destructor.
  class Busy {
   public:
    explicit Busy(Team& team) : held_(std::make_shared<std::promise<void>>()) {
      auto until = std::make_shared<std::shared_future<void>>(held_->get_future());
      team.served.on_loop(
          [&] { team.front.workers->submit(loop::Urgency::OnTheWay, [until] { until->wait(); }, [] {}); });
    }
    Busy(const Busy&) = delete;
    Busy& operator=(const Busy&) = delete;
    ~Busy() { end(); }
    void end() {
      if (held_) held_->set_value();
      held_ = nullptr;
    }

   private:
    std::shared_ptr<std::promise<void>> held_;
  };

 private:
  /// Forwards to the routes, which need the loop's thread.
  struct Front final : Handler {
    explicit Front(Team& owner) : team(owner) {}
    Credentials read_credentials(const RequestHead& head) override { return routes->read_credentials(head); }
    std::unique_ptr<BodySink> open(const RequestHead& head, std::shared_ptr<Responder> responder,
                                   std::shared_ptr<FlowControl> flow) override {
      return routes->open(head, std::move(responder), std::move(flow));
    }
    Team& team;
    std::unique_ptr<loop::Workers> workers;
    std::unique_ptr<IcdRoutes> routes;
  };
  IcdOptions options_;
  NotFound not_found_;

 public:
  FakeMessageHandler message_handler;
  Front front{*this};
  Served served{front, {.address = {}, .interface = {}, .late = std::chrono::milliseconds(0)}};

 private:
  const bool ready_ = served.on_loop([this] {
    front.workers = std::make_unique<loop::Workers>(served.loop(), 1);
    front.routes = std::make_unique<IcdRoutes>(options_, message_handler, *front.workers, not_found_);
    return true;
  });
};

/// A request with the team's token.
inline std::string authorized(std::string_view method, std::string_view path, std::string_view headers = {},
                              std::string_view body = {}) {
  return request(method, path, "Authorization: Bearer " + std::string(kToken) + "\r\n" + std::string(headers),
                 body);
}

inline constexpr std::string_view kJsonType = "Content-Type: application/json\r\n";
inline constexpr std::string_view kCborType = "Content-Type: application/cbor\r\n";
inline const std::string kGzip = "Content-Encoding: gzip\r\n";

inline constexpr std::string_view kReportBody = R"({"x": 1.5, "y": -2, "z": 0, "type": "Backpack"})";
inline constexpr std::string_view kStateBody =
    R"({"poses": [{"name": "r1", "position": {"x": 1, "y": 2, "z": 3},
        "orientation": {"x": 0, "y": 0, "z": 0, "w": 1}}]})";
inline constexpr std::string_view kMarkersBody = R"({"markers": [{"ns": "a", "id": 1, "action": 2}]})";

/// A grid of unknown cells in JSON.
inline std::string grid_body(std::uint32_t width, std::uint32_t height) {
  const std::size_t cells = static_cast<std::size_t>(width) * height;
  std::string data(cells / 3 * 4, '/');
  if (cells % 3 == 1) data += "/w==";
  if (cells % 3 == 2) data += "//8=";
  return R"({"type": "OccupancyGrid", "name": "r1", "msg": {"info": {"resolution": 0.1, "width": )" +
         std::to_string(width) + R"(, "height": )" + std::to_string(height) +
         R"(, "origin": {"position": {"x": 0, "y": 0, "z": 0}, "orientation": {"x": 0, "y": 0, "z": 0, "w": 1}}},
         "data": ")" +
         data + R"("}})";
}

/// A cloud in JSON.
inline std::string cloud_body(std::size_t points) {
  const auto field = [](const char* name, int offset) {
    return std::string(R"({"name": ")") + name + R"(", "offset": )" + std::to_string(offset) +
           R"(, "datatype": 7, "count": 1})";
  };
  std::string data;
  for (std::size_t i = 0; i < points; ++i) data += i % 2 == 0 ? "AAAAAAAAgD8AAABA" : "AACAPwAAAEAAAAAA";
  return R"({"type": "PointCloud2", "name": "r1", "msg": {"fields": [)" + field("x", 0) + ", " +
         field("y", 4) + ", " + field("z", 8) + R"(], "point_step": 12, "data": ")" + data + R"("}})";
}

/// As grid_body(), but its type follows the data, so cells stay uncompressed until then.
inline std::string grid_with_late_type(std::uint32_t width, std::uint32_t height) {
  constexpr std::string_view kType = R"("type": "OccupancyGrid", )";
  std::string body = grid_body(width, height);
  body.erase(body.find(kType), kType.size());
  body.insert(body.size() - 1, R"(, "type": "OccupancyGrid")");
  return body;
}

/// The head of a map upload with `more` header fields.
inline std::string map_head(const std::string& body, std::string_view more = {}) {
  return authorized(
      "POST", "/map/update",
      std::string(kJsonType) + std::string(more) + "Content-Length: " + std::to_string(body.size()) + "\r\n");
}

/// True for a JSON string, the body of each rejection (ICD 4).
inline bool is_json_string(const std::string& body) {
  return nlohmann::json::parse(body, nullptr, false).is_string();
}

}  // namespace adit::intake
