// What OpenEXR throws, as ours. Private to src/image.
#pragma once

#include <algorithm>
#include <filesystem>
#include <new>
#include <string>
#include <string_view>

#include "base/error.h"

namespace peelray {

/// Calls `work` and turns OpenEXR's exceptions into ours, on one line.
template <typename Work>
auto guarded(std::string_view doing, const std::filesystem::path& path, Work&& work) {
    try {
        return work();
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        fail("cannot {} {}: not enough memory", doing, path.string());
    } catch (const std::exception& error) {
        std::string text = error.what();
        std::replace(text.begin(), text.end(), '\n', ' ');
        fail("cannot {} {}: OpenEXR says: {}", doing, path.string(), text);
    }
}

}  // namespace peelray
