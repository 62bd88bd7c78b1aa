#pragma once

#include <concepts>
#include <functional>
#include <memory>
#include <string>
#include <type_traits>

#include "api/after.hpp"
#include "api/answers.hpp"
#include "api/number_in.hpp"
#include "api/route.hpp"

namespace adit::api {

template <class Function>
struct Signature;
template <class Class, class Gives>
struct Signature<Gives (Class::*)()> {
  using Handler = Class;
  using Argument = void;
};
template <class Class, class Gives, class Parameter>
struct Signature<Gives (Class::*)(Parameter)> {
  using Handler = Class;
  using Argument = std::remove_cvref_t<Parameter>;
};
template <class Class, class Gives>
struct Signature<Gives (Class::*)() const> : Signature<Gives (Class::*)()> {};
template <class Class, class Gives, class Parameter>
struct Signature<Gives (Class::*)(Parameter) const> : Signature<Gives (Class::*)(Parameter)> {};

template <class Class, class Gives>
struct Signature<Gives (*)(Class&)> : Signature<Gives (std::remove_const_t<Class>::*)()> {};
template <class Class, class Gives, class Parameter>
struct Signature<Gives (*)(Class&, Parameter)> : Signature<Gives (std::remove_const_t<Class>::*)(Parameter)> {
};

/// The result of a handler's function, as the Answer if it is a row or the success of an action.
template <class Handler, class Result>
auto answered(const Handler& handler, Result result) {
  if constexpr (std::same_as<Result, icd::Checked<void>>) {
    return after(handler, result);
  } else if constexpr (requires { Result::kRow; }) {
    return fresh(result);
  } else {
    return result;
  }
}

template <auto function, auto reader>
auto call_of(const Handlers& handlers, const Call& call) {
  using Argument = Signature<decltype(function)>::Argument;
  auto& handler = *std::get<typename Signature<decltype(function)>::Handler*>(handlers);
  if constexpr (!std::is_null_pointer_v<decltype(reader)>) {
    const auto read = reader(call.body);
    return read ? answered(handler, std::invoke(function, handler, *read)) : refused(read.error());
  } else if constexpr (std::is_void_v<Argument>) {
    return answered(handler, std::invoke(function, handler));
  } else if constexpr (std::integral<Argument>) {
    const auto number = icd::number_in<Argument>(call.parameters.front());
    return number ? std::invoke(function, handler, *number) : nothing_at(call.head.path());
  } else if constexpr (std::same_as<Argument, std::string>) {
    return std::invoke(function, handler, call.body);
  } else if constexpr (std::same_as<Argument, intake::RequestHead>) {
    return std::invoke(function, handler, call.head);
  } else {
    return std::invoke(function, handler, call);
  }
}

/// Wraps a function on one of the Handlers: a member, or with the handler as first parameter. Its parameter
/// is what `reader` reads from the body; without a reader the number in the path (404 if it is not a number),
/// the body (std::string), the RequestHead or the Call. It returns the Answer, a row, or the success of an
/// action (api/after.hpp), or void and answers by Call::responder, or the object that receives the body.
template <auto function, auto reader = nullptr>
consteval Handle by() {
  constexpr auto kCall = call_of<function, reader>;
  using Gives = std::invoke_result_t<decltype(kCall), const Handlers&, const Call&>;
  if constexpr (std::same_as<Gives, intake::Answer>) {
    return {.answer = kCall};
  } else if constexpr (std::is_void_v<Gives>) {
    return {.answer_later = kCall};
  } else {
    return {.begin = kCall};
  }
}

}  // namespace adit::api
