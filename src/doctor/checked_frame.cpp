#include "doctor/checked_frame.h"

#include <algorithm>
#include <chrono>

#include "base/elapsed.h"
#include "base/error.h"
#include "image/metrics.h"
#include "workspace/workspace.h"

namespace peelray {
namespace {

/// Pixels at edges may fall on either side.
constexpr double kMostDifferent = 0.01;

PictureArguments checked_picture(Tracer tracer, const std::string& device) {
    PictureArguments picture;
    picture.scene = kCheckedScene;
    picture.size = kCheckedSize;
    picture.tracing.tracer = tracer;
    picture.device.device = device;
    return picture;
}

Image8 image_of(const Picture& picture) {
    return {picture.width, picture.height, picture.encoded};
}

}  // namespace

std::optional<Image8> reference_frame(std::string& cause) {
    try {
        return image_of(Workspace(checked_picture(Tracer::reference, "")).render().picture);
    } catch (const Error& error) {
        cause = error.line("--");
        return std::nullopt;
    }
}

CheckedFrame check_frame(Tracer tracer, const std::string& device, const std::optional<Image8>& expected) {
    CheckedFrame out;
    try {
        auto start = std::chrono::steady_clock::now();
        Workspace workspace(checked_picture(tracer, device));
        workspace.check(tracer);
        out.renderer = workspace.renderer_name(tracer);
        workspace.render();
        out.first_seconds = seconds_since(start);
        start = std::chrono::steady_clock::now();
        const MadePicture made = workspace.render();
        out.frame_ms = is_on_cpu(tracer) ? 1000 * seconds_since(start) : made.stats.render.frame_ms;
        const Image8 image = image_of(made.picture);
        if (expected) {
            out.different = share_different(*expected, image);
            if (out.different > kMostDifferent)
                out.cause = fmt::format(
                    "{:.1f} % of the pixels of a checked picture are wrong: the driver is at fault, update it",
                    100 * out.different);
        } else if (std::all_of(image.pixels.begin(), image.pixels.end(),
                               [&](uint32_t pixel) { return pixel == image.pixels.front(); })) {
            out.cause = "a picture is of one colour: the driver is at fault, update it";
        }
        out.passed = out.cause.empty();
    } catch (const std::bad_alloc&) {
        out.cause = "out of memory";
    } catch (const Error& error) {
        out.cause = error.line("--");
    }
    return out;
}

}  // namespace peelray
