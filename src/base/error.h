// Errors that are the input's or the device's fault. A programming error is an assert, an expected miss a return value.
#pragma once

#include <fmt/core.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace peelray {

/// Bad input or a device that cannot do what is asked. `what()` is one line: what, where, what to do.
/// The programs print it after "peelray: " and exit with status 1.
class Error : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// Throws Error with a formatted line.
template <typename... Args>
[[noreturn]] void fail(fmt::format_string<Args...> format, Args&&... args) {
    throw Error(fmt::format(format, std::forward<Args>(args)...));
}

}  // namespace peelray
