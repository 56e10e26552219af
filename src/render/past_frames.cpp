#include "render/past_frames.h"

#include <algorithm>
#include <cassert>

#include "render/denoiser.h"
#include "render/frame_state.h"

namespace peelray {

void PastFrames::prepare(const PictureSettings& settings) {
    const MemoryPart part(device_, "images");
    const uint64_t pixels = pixels_of(settings);
    const glm::uvec2 size(settings.width, settings.height);
    const bool other = size != size_;
    size_ = size;
    for (Kept& each : kept_) {
        if (other) each.number.reset();
        ensure_size(device_, each.past, "surfaces of a past picture", pixels * sizeof(glm::uvec4));
        ensure_size(device_, each.light, "light of a past picture", pixels * sizeof(glm::vec4));
        ensure_size(device_, each.motion, "motion of a past picture", pixels * sizeof(glm::vec3));
    }
    ensure_size(device_, motions_, "motion in the denoiser", pixels * sizeof(DenoiseMotion));
    ensure_size(device_, trails_, "trails in the denoiser", pixels * sizeof(DenoiseTrail));
}

uint64_t PastFrames::bytes() const {
    uint64_t bytes = motions_.bytes() + images_.bytes() + trails_.bytes();
    for (const Kept& each : kept_) bytes += each.past.bytes() + each.light.bytes() + each.motion.bytes();
    return bytes;
}

PastFrames::Kept& PastFrames::kept(int64_t number) {
    const auto count = int64_t(kept_.size());
    return kept_[size_t((number % count + count) % count)];
}

void PastFrames::record_motion(FrameState& f, uint32_t level, uint32_t first_row, const Buffer& links) {
    ensure_size(device_, images_, "images in mirrors in the denoiser",
                std::max<uint64_t>(images_.bytes(), uint64_t(f.bands.most_pixels()) * sizeof(DenoiseImage)));
    const PathQueues& queues = f.queues;
    const PathLevel &here = queues.level(level), &incoming = queues.level(level > 0 ? level - 1 : 0);
    const bool camera_kept = f.layered(), kept = level > 0 || camera_kept, incoming_kept = level > 1 || camera_kept;
    DenoiseMotionParams p{};
    p.before = f.before.camera();
    p.capacity = f.bands.pixels(first_row);
    p.jitter = sample_position(0);
    p.first_row = first_row;
    p.level_capacity = level > 0 ? here.capacity : p.capacity;
    f.commands.run(device_.pass("denoise_motion", {{"camera", level == 0},
                                                   {"by_number", f.view.by_number()},
                                                   {"kept", kept},
                                                   {"incoming_kept", incoming_kept}}),
                   {{"frame", f.view.target.frame},
                    {"positions", f.scene.triangles.positions},
                    {"triangles", f.scene.triangles.triangles},
                    {"instances", f.scene.instances.table()},
                    Binding::if_used("positions_before", f.before.positions()),
                    {"transforms_before", f.before.transforms()},
                    {"triangle_objects", f.scene.triangle_objects},
                    Binding::if_used("rays", kept ? &here.traced->rays : nullptr),
                    Binding::if_used("hits", kept ? &here.traced->hits : nullptr),
                    Binding::if_used("incoming_rays", incoming_kept ? &incoming.traced->rays : nullptr),
                    Binding::if_used("incoming_hits", incoming_kept ? &incoming.traced->hits : nullptr),
                    {"visibility", f.view.target.visibility},
                    {"draws", f.scene.draw_table},
                    {"queue", queues.counters()},
                    {"denoise_links", links},
                    {"denoise_images", images_},
                    {"denoise_motions", motions_}},
                   p, groups_for(p.capacity, 64));
}

void PastFrames::record_memory(Commands& commands, const PictureSettings& settings, const Buffer& features,
                               const Buffer& signal) {
    Kept& now = kept(settings.number);
    now.number = settings.number;
    commands.run(device_.pass("denoise_remember"),
                 {{"features", features},
                  {"signal", signal},
                  {"denoise_motions", motions_},
                  {"past", now.past},
                  {"past_light", now.light},
                  {"past_motion", now.motion}},
                 DenoiseParams{settings.width, settings.height, 1}, tiles_of(settings));
}

void PastFrames::record_mean(Commands& commands, const PictureSettings& settings, const Buffer& features,
                             const Buffer& signal, const Buffer& mean) {
    const Kept& now = kept(settings.number);
    for (int64_t back = 1; back <= DENOISE_WARM_UP; back++) {
        const Kept& then = kept(settings.number - back);
        assert(then.number == settings.number - back);
        commands.run(device_.pass("denoise_reproject", {{"first", back == 1}, {"last", back == DENOISE_WARM_UP}}),
                     {{"features", features},
                      {"signal", signal},
                      {"present", now.past},
                      {"present_motion", now.motion},
                      {"past", then.past},
                      {"past_light", then.light},
                      {"past_motion", then.motion},
                      {"denoise_trails", trails_},
                      {"accumulated", mean}},
                     DenoiseParams{settings.width, settings.height, 1}, tiles_of(settings));
    }
}

}  // namespace peelray
