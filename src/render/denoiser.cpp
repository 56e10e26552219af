#include "render/denoiser.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "render/frame_state.h"

namespace peelray {
void Denoiser::prepare(const PictureSettings& settings) {
    const MemoryPart part(device_, "images");
    const uint64_t pixels = pixels_of(settings);
    ensure_size(device_, guides_, "guides of the denoiser", pixels * sizeof(DenoiseGuide));
    ensure_size(device_, features_, "features of the denoiser", pixels * sizeof(glm::uvec4));
    for (Buffer* signal : {&first_, &one_, &two_})
        ensure_size(device_, *signal, "light in the denoiser", pixels * sizeof(glm::vec4));
    if (!is_temporal(settings)) past_.reset();
    if (is_temporal(settings) && !past_) past_ = std::make_unique<PastFrames>(device_);
    if (past_) past_->prepare(settings);
}

uint64_t Denoiser::bytes() const {
    return guides_.bytes() + links_.bytes() + features_.bytes() + first_.bytes() + one_.bytes() + two_.bytes() +
           (past_ ? past_->bytes() : 0);
}

void Denoiser::record_guides(FrameState& f, uint32_t sample, uint32_t first_row) {
    ensure_size(device_, links_, "links of the denoiser",
                std::max<uint64_t>(links_.bytes(), uint64_t(f.bands.most_pixels()) * sizeof(DenoiseLink)));
    for (uint32_t level = 0; level <= f.last_level; level++) {
        if (past_ && sample == 0) past_->record_motion(f, level, first_row, links_);
        record_level(f, level, sample, first_row);
    }
}

void Denoiser::record_level(FrameState& f, uint32_t level, uint32_t sample, uint32_t first_row) {
    const PathQueues& queues = f.queues;
    const PathLevel &here = queues.level(level), &next = queues.level(level + 1);
    const bool kept = level > 0 || f.layered();
    DenoiseGuideParams p{};
    p.capacity = f.bands.pixels(first_row);
    p.level_capacity = level > 0 ? here.capacity : p.capacity;
    p.next_capacity = next.capacity;
    p.light_capacity = queues.lights().capacity;
    p.jitter = sample_position(sample);
    p.first_row = first_row;
    p.sample_index = sample;
    p.samples_lobes = is_sampled(f.settings);
    p.finds_light = f.lights_per_hit() > 0 || f.indirect();
    p.limit = f.settings.clamp.value_or(std::numeric_limits<float>::max());
    f.commands.run(device_.pass("denoise_guides", {{"camera", level == 0},
                                                   {"by_number", !kept && f.view.by_number()},
                                                   {"kept", kept},
                                                   f.scene.base_colors.constant()}),
                   surface_bindings(f.scene, f.view.target.frame,
                                    {Binding::if_used("rays", kept ? &here.traced->rays : nullptr),
                                     Binding::if_used("states", kept ? &here.traced->states : nullptr),
                                     Binding::if_used("hits", kept ? &here.traced->hits : nullptr),
                                     {"nodes", here.nodes},
                                     {"branches", here.branches},
                                     {"next_nodes", next.nodes},
                                     {"shadow_light", queues.lights().light},
                                     {"queue", queues.counters()},
                                     {"visibility", f.view.target.visibility},
                                     {"draws", f.scene.draw_table},
                                     {"denoise_links", links_},
                                     {"denoise_guides", guides_}}),
                   p, groups_for(p.capacity, 64));
}

void Denoiser::record_preparation(Commands& commands, const PictureSettings& settings) {
    commands.run(device_.pass("denoise_prepare"),
                 {{"denoise_guides", guides_}, {"features", features_}, {"signal", first_}},
                 DenoiseParams{settings.width, settings.height, 1}, groups_for(pixels_of(settings), 64));
    if (past_) past_->record_memory(commands, settings, features_, first_);
}

void Denoiser::record_memory(Commands& commands, const PictureSettings& settings) {
    commands.begin_group("denoise");
    record_preparation(commands, settings);
    commands.end_group();
}

void Denoiser::record_filter(Commands& commands, const Buffer& picture, const PictureSettings& settings) {
    DenoiseParams p{settings.width, settings.height, 1};
    const Groups tiles = tiles_of(settings);
    commands.begin_group("denoise");
    record_preparation(commands, settings);
    if (past_) past_->record_mean(commands, settings, features_, first_, two_);
    commands.run(device_.pass("denoise_outliers"),
                 {{"features", features_}, {"signal", past_ ? two_ : first_}, {"filtered_signal", one_}}, p, tiles);
    if (past_)
        commands.run(device_.pass("denoise_variance_past"),
                     {{"features", features_}, {"signal", one_}, {"filtered_signal", two_}, {"first_signal", first_}},
                     p, tiles);
    else
        commands.run(device_.pass("denoise_variance", {{"one_sample", settings.spp == 1}}),
                     {{"features", features_}, {"signal", one_}, {"filtered_signal", two_}}, p, tiles);
    const Buffer *from = &two_, *to = &one_;
    for (uint32_t i = 0; i < DENOISE_ITERATIONS; i++, p.step *= 2, std::swap(from, to))
        commands.run(device_.pass("denoise_filter", {{"last", i + 1 == DENOISE_ITERATIONS}}),
                     {{"features", features_},
                      {"signal", *from},
                      {"filtered_signal", *to},
                      {"first_signal", first_},
                      {"denoise_guides", guides_},
                      {"picture", picture}},
                     p, tiles);
    commands.end_group();
}

}  // namespace peelray
