#pragma once

#include <optional>
#include <string>

#include "intake/server.hpp"
#include "intake/target.hpp"

struct MHD_Connection;

namespace adit::intake {

/// The head of a request. libmicrohttpd keeps its fields.
class Head final : public RequestHead {
 public:
  Head(MHD_Connection* connection, std::string_view method, Target target, const std::string& peer,
       const std::string& local, std::uint64_t number, std::optional<std::uint64_t> length)
      : connection_(connection),
        method_(method),
        target_(std::move(target)),
        peer_(peer),
        local_(local),
        number_(number),
        length_(length) {}

  std::string_view method() const override { return method_; }
  std::string_view path() const override { return target_.path; }
  std::string_view query(std::string_view name) const override;
  std::string_view header(std::string_view name) const override;
  std::optional<std::uint64_t> content_length() const override { return length_; }
  const std::string& peer() const override { return peer_; }
  const std::string& local() const override { return local_; }
  std::uint64_t connection() const override { return number_; }

 private:
  MHD_Connection* connection_;
  std::string method_;
  Target target_;
  const std::string& peer_;
  const std::string& local_;
  std::uint64_t number_;
  std::optional<std::uint64_t> length_;
};

}  // namespace adit::intake
