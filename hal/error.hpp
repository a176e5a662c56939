// The one error type of the project: what went wrong, where, and what to do about it.
#pragma once

#include <expected>
#include <string>
#include <utility>

namespace gridrt {

/// What kind of failure an Error reports; programs map it to their exit code.
enum class ErrorKind {
  kUsage,        ///< an option or argument is wrong
  kInput,        ///< the content of a file is wrong (the message names file and line or element)
  kFile,         ///< a file cannot be opened, read or written
  kUnsupported,  ///< this build or this device cannot do it
  kLimit,        ///< a size exceeds what a format or a device holds
  kTransport,    ///< bytes could not be moved to or from a device
  kTimeout,      ///< a device did not answer in time
  kProtocol,     ///< a frame, report or record is not as the protocol says
  kDevice,       ///< the device reported an error of its own
  kInternal,     ///< a defect of this program
};

/// A failure with a message that names the place and advice that says what to do.
struct Error {
  ErrorKind kind = ErrorKind::kInternal;
  std::string message = {};
  std::string advice = {};  ///< empty where the message says it all
};

/// A value or an Error; the return type of everything that can fail.
template <class T>
using Result = std::expected<T, Error>;

/// Makes the error half of a Result.
inline std::unexpected<Error> fail(ErrorKind kind, std::string message, std::string advice = {}) {
  return std::unexpected(Error{kind, std::move(message), std::move(advice)});
}

}  // namespace gridrt
