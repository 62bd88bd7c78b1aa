#pragma once

#include <functional>
#include <memory>
#include <string_view>

#include "api/network.hpp"
#include "api/self_test.hpp"
#include "intake/server.hpp"

namespace adit::api {

/// The box's own addresses and the Test, for those whom Entrance let in: README.md.
class NetworkRoutes {
 public:
  /// `changed` is called after each action. All outlive this.
  NetworkRoutes(Network& network, SelfTest& test, std::function<void()> changed)
      : network_(network), test_(test), changed_(std::move(changed)) {}

  static bool has(std::string_view path);
  /// Requires has(head.path()).
  std::unique_ptr<intake::BodySink> open(const intake::RequestHead& head,
                                         std::shared_ptr<intake::Responder> responder);

 private:
  intake::Answer shown() const;
  intake::Answer tested() const;
  intake::Answer post(std::string_view path, const std::string& body, const std::string& peer,
                      const std::string& local);
  intake::Answer check(const std::string& body, const std::string& peer) const;
  intake::Answer change(const std::string& body, const std::string& peer);
  /// How it stands now, or why the action was refused.
  intake::Answer after(const icd::Checked<void>& done) const;

  Network& network_;
  SelfTest& test_;
  std::function<void()> changed_;
};

}  // namespace adit::api
