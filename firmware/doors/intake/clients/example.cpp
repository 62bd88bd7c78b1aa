// ADIT_TOKEN=... example http://10.0.0.1:8000 report 10.5 -3.25 0.4 Backpack (or: status, map, state,
// markers; with --bare for a Command Post without Adit). Prints the answer. Exit status: 1 if the message was
// rejected, 2 if the words are wrong, 3 if a person must decide.
//     apt install g++ libcurl4-openssl-dev nlohmann-json3-dev   (JSON for Modern C++, 3.8 or newer)
//     g++ -std=c++17 example.cpp -o example -lcurl
#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <stdexcept>
#include <vector>

#include "client.hpp"

using nlohmann::json;

namespace {

const json kPose = {{"position", {{"x", 1.0}, {"y", 2.0}, {"z", 0.0}}},
                    {"orientation", {{"x", 0.0}, {"y", 0.0}, {"z", 0.0}, {"w", 1.0}}}};

json header() {
  const std::chrono::duration<double> now = std::chrono::system_clock::now().time_since_epoch();
  return {{"stamp", now.count()}, {"frame_id", "darpa"}};
}

json a_map() {  // free, free, occupied, unknown: row by row from the lower left
  std::vector<std::uint8_t> cells = {0, 0, 100, 255, 0, 0, 100, 255, 0, 0, 100, 255};
  const json info = {{"resolution", 0.1}, {"width", 4}, {"height", 3}, {"origin", kPose}};
  const json grid = {{"header", header()}, {"info", info}, {"data", json::binary(std::move(cells))}};
  return {{"type", "OccupancyGrid"}, {"name", "r1"}, {"msg", grid}};
}

json a_state() {
  json pose = kPose;
  pose["name"] = "r1";
  return {{"header", header()}, {"poses", json::array({pose})}};
}

json some_markers() {
  const json scale = {{"x", 1.0}, {"y", 1.0}, {"z", 1.0}};
  const json color = {{"r", 1.0}, {"g", 0.5}, {"b", 0.0}, {"a", 1.0}};
  const json ball = {{"header", header()}, {"ns", "artifacts"}, {"id", 1},        {"type", 2},
                     {"action", 0},        {"pose", kPose},     {"scale", scale}, {"color", color}};
  return {{"markers", json::array({ball})}};
}

json ask(Client& client, const std::vector<std::string>& words) {
  const std::string& what = words.at(1);
  if (what == "status") return client.status();
  if (what == "map") return client.update(what, a_map());
  if (what == "state") return client.update(what, a_state());
  if (what == "markers") return client.update(what, some_markers());
  if (what != "report" || words.size() != 6)
    throw std::invalid_argument("expected report X Y Z TYPE, status, map, state or markers");
  return client.report(std::stod(words.at(2)), std::stod(words.at(3)), std::stod(words.at(4)), words.at(5));
}

}  // namespace

int main(int count, char** given) {
  std::vector<std::string> words(given + 1, given + count);
  const bool bare = !words.empty() && words.back() == "--bare";
  if (bare) words.pop_back();
  const char* const token = std::getenv("ADIT_TOKEN");
  try {
    if (token == nullptr) throw std::invalid_argument("the variable ADIT_TOKEN is not set");
    if (words.size() < 2) throw std::invalid_argument("expected a URL, and what to send");
    Client client(words.at(0), token == nullptr ? "" : token, bare);
    std::cout << ask(client, words) << "\n";
    return 0;
  } catch (const std::logic_error& why) {  // also of a word that is no number
    std::cerr << why.what()
              << "\nusage: ADIT_TOKEN=... example URL report X Y Z TYPE (or: status, map, state, markers) "
                 "[--bare]\n";
    return 2;
  } catch (const Refused& why) {
    std::cerr << "refused: " << why.what() << "\n";
    return 1;
  } catch (const std::exception& why) {
    std::cerr << "not known: " << why.what() << "\n";
    return 3;
  }
}
