// What a user should know although nothing went wrong. Nothing below the command line prints.
#pragma once

#include <functional>
#include <string>

namespace peelray {

/// Takes notes, a line each; settings in them are written as a Setting is formatted. May be empty: nobody listens.
using Notes = std::function<void(const std::string& text)>;

inline void note(const Notes& notes, const std::string& text) {
    if (notes) notes(text);
}

}  // namespace peelray
