// A small picture, by any tracer, compared with the reference's.
#pragma once

#include <optional>
#include <string>

#include "image/image.h"
#include "settings/settings.h"

namespace peelray {

/// The picture, and what makes it.
constexpr const char* kCheckedScene = "builtin:teapots";
constexpr glm::uvec2 kCheckedSize{96, 72};

struct CheckedFrame {
    bool passed = false;
    std::string cause;                       ///< why not
    std::string renderer;                    ///< what drew it
    double first_seconds = 0, frame_ms = 0;  ///< of the first picture with all that is made for it; of the next
    double different = 0;                    ///< share of the pixels that are not the reference's
};

/// By the reference, in double precision; none where this program has none, and `cause` why.
std::optional<Image8> reference_frame(std::string& cause);

/// Draws it twice, by a tracer and on a device (DeviceOptions::select), and compares it with `expected`, if there is
/// one. Never throws for what a device or its driver does.
CheckedFrame check_frame(Tracer tracer, const std::string& device, const std::optional<Image8>& expected);

}  // namespace peelray
