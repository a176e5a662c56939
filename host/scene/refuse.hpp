// How the readers of nested formats give up: they throw a Refusal, which their entry function
// catches and returns as an Error. It never leaves this library.
#pragma once

#include <exception>
#include <string>
#include <type_traits>
#include <utility>

#include "hal/error.hpp"

namespace gridrt::scene_detail {

/// Carries an Error up to the entry function of a reader.
class Refusal : public std::exception {
 public:
  explicit Refusal(Error error) : error_(std::move(error)) {}
  const Error& error() const { return error_; }
  const char* what() const noexcept override { return error_.message.c_str(); }

 private:
  Error error_;
};

/// Throws a Refusal.
[[noreturn]] inline void refuse(ErrorKind kind, std::string message, std::string advice = {}) {
  throw Refusal(Error{kind, std::move(message), std::move(advice)});
}

/// The value of a Result, or throws its error as a Refusal.
template <class T>
T require(Result<T> result) {
  if (!result) {
    throw Refusal(std::move(result.error()));
  }
  if constexpr (!std::is_void_v<T>) {
    return std::move(*result);
  }
}

}  // namespace gridrt::scene_detail
