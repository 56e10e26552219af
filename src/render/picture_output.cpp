#include "render/picture_output.h"

#include <cmath>

namespace peelray {
namespace {

uint64_t pixels_of(const PictureSettings& settings) {
    return uint64_t(settings.width) * settings.height;
}

/// Of a sum over the samples.
float scale_of(const PictureSettings& settings) {
    return std::exp2(settings.exposure) / float(settings.spp);
}

}  // namespace

void PictureOutput::prepare(const PictureSettings& settings, bool unlit) {
    const MemoryPart part(device_, "images");
    ensure_size(device_, picture_, "picture", pixels_of(settings) * 16);
    ensure_size(device_, encoded_, "encoded picture", pixels_of(settings) * 4);
    has_unlit_ = unlit;
    if (unlit) ensure_size(device_, unlit_, "unlit colours", pixels_of(settings) * sizeof(glm::vec3));
}

void PictureOutput::record_accumulation(Commands& commands, const PathQueues& queues, const Buffer& frame,
                                        const LevelParams& p, const PictureSettings& settings) {
    const bool last = p.sample_index + 1 == settings.spp;
    commands.run(device_.pass("accumulate", {{"has_unlit", has_unlit_}}),
                 {{"frame", frame},
                  {"nodes", queues.level(0).nodes},
                  {"branches", queues.level(0).branches},
                  {"next_nodes", queues.level(1).nodes},
                  {"shadow_light", queues.lights().light},
                  {"queue", queues.counters()},
                  {"picture", picture_},
                  {"encoded", encoded_},
                  unlit()},
                 AccumulateParams{p.capacity, p.next_capacity, p.light_capacity, p.first_row, p.sample_index, last,
                                  last && post_passes_.empty(), scale_of(settings), 1 / float(settings.spp),
                                  uint32_t(settings.tonemap), settings.backdrop.is_transparent()},
                 groups_for(p.capacity, 64));
}

bool PictureOutput::record_post(Commands& commands, const PictureSettings& settings) {
    if (post_passes_.empty()) return false;
    for (const PostPass& pass : post_passes_) pass(commands, picture_, settings);
    const uint64_t pixels = pixels_of(settings);
    commands.run(device_.pass("encode", {{"has_unlit", has_unlit_}}),
                 {{"picture", picture_}, {"encoded", encoded_}, unlit()},
                 EncodeParams{uint32_t(pixels), scale_of(settings), 1 / float(settings.spp), uint32_t(settings.tonemap),
                              settings.backdrop.is_transparent()},
                 groups_for(pixels, 64));
    return true;
}

void PictureOutput::download(Commands& commands, const PictureSettings& settings, Picture& out) const {
    out.width = settings.width;
    out.height = settings.height;
    out.transparent = settings.backdrop.is_transparent();
    out.radiance = commands.download<glm::vec4>(picture_, pixels_of(settings));
    for (glm::vec4& pixel : out.radiance) pixel /= float(settings.spp);
    out.encoded = commands.download<uint32_t>(encoded_, pixels_of(settings));
}

}  // namespace peelray
