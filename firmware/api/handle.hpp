#pragma once

#include <concepts>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

#include "api/answers.hpp"
#include "api/number_in.hpp"
#include "api/route.hpp"

namespace adit::api {

template <class Function>
struct Signature;
template <class Class, class Answers, class... Arguments>
struct Signature<Answers (Class::*)(Arguments...)> {
  using Handler = Class;

  /// 404 where a number of the path is none.
  template <auto function>
  static std::unique_ptr<intake::BodySink> pass(Handler& handler, Call& call) {
    if (!(has<std::remove_cvref_t<Arguments>>(call) && ...)) {
      call.responder->answer(nothing_here());
      return nullptr;
    }
    if constexpr (std::same_as<Answers, intake::Answer>) {
      call.responder->answer((handler.*function)(argument<std::remove_cvref_t<Arguments>>(call)...));
      return nullptr;
    } else if constexpr (std::is_void_v<Answers>) {
      (handler.*function)(argument<std::remove_cvref_t<Arguments>>(call)...);
      return nullptr;
    } else {
      return (handler.*function)(argument<std::remove_cvref_t<Arguments>>(call)...);
    }
  }

 private:
  template <class Argument>
  static bool has(const Call& call) {
    if constexpr (std::integral<Argument>) return number_in<Argument>(call.parameters.front()).has_value();
    return true;
  }
  template <class Argument>
  static decltype(auto) argument(Call& call) {
    if constexpr (std::integral<Argument>) {
      return number_in<Argument>(call.parameters.front()).value_or(0);
    } else if constexpr (std::same_as<Argument, std::string>) {
      return std::as_const(call.body);
    } else if constexpr (std::same_as<Argument, intake::RequestHead>) {
      return (call.head);
    } else {
      return std::as_const(call);
    }
  }
};
template <class Class, class Answers, class... Arguments>
struct Signature<Answers (Class::*)(Arguments...) const> : Signature<Answers (Class::*)(Arguments...)> {};

/// Calls a member function of one of the Handlers with what it asks for by its parameters' types: a number is
/// that of the path, a std::string the body, and there are the RequestHead and the whole Call. It gives the
/// Answer; or nothing, and answers by Call::responder; or what takes the body.
template <auto function>
consteval Handle by() {
  using Of = Signature<decltype(function)>;
  using Handler = Of::Handler;
  return {[](const Handlers& handlers) { return std::get<Handler*>(handlers) != nullptr; },
          [](const Handlers& handlers, Call& call) {
            return Of::template pass<function>(*std::get<Handler*>(handlers), call);
          }};
}

}  // namespace adit::api
