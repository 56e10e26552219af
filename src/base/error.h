// Errors that are the input's or the device's fault. A programming error is an assert, an expected miss a return value.
#pragma once

#include <fmt/core.h>

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "base/setting.h"

namespace peelray {

/// Bad input or a device that cannot do what is asked. `what()` is one line: what, where, what to do.
/// The programs print it after "peelray: " and exit with status 1.
class Error : public std::runtime_error {
  public:
    /// `text`: settings in it are written as a Setting is formatted.
    explicit Error(const std::string& text);

    /// The settings at fault, or that could be chosen otherwise, in the order in which the line names them; each once.
    const std::vector<std::string>& settings() const { return settings_; }

    /// The line with `prefix` before the name of each setting: "--" makes them the flags of the command line. In
    /// what() the names stand alone.
    std::string line(std::string_view prefix) const;

    /// The line with its settings still marked, for an Error that tells more.
    const std::string& text() const { return text_; }

  private:
    std::string text_;
    std::vector<std::string> settings_;
};

/// A device that binds or holds less than is needed: less of it may work. Whoever can do with less catches this one.
class NoRoom : public Error {
  public:
    /// `reason`: what does not fit; `advice`: what to do about it.
    NoRoom(const std::string& reason, const std::string& advice) : Error(reason + ": " + advice), reason_(reason) {}

    /// Without what to do.
    const std::string& reason() const { return reason_; }

  private:
    std::string reason_;
};

/// Throws Error with a formatted line. Arguments that are a Setting are those at fault.
template <typename... Args>
[[noreturn]] void fail(fmt::format_string<Args...> format, Args&&... args) {
    throw Error(fmt::format(format, std::forward<Args>(args)...));
}

}  // namespace peelray
