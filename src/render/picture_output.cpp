#include "render/picture_output.h"

#include <cmath>
#include <limits>

#include "scene/passes.h"

namespace peelray {
namespace {

/// Of a sum over the samples.
float scale_of(const PictureSettings& settings) {
    return std::exp2(settings.exposure) / float(settings.spp);
}

}  // namespace

void PictureOutput::prepare(const PictureSettings& settings, bool unlit, bool open, bool denoises) {
    const MemoryPart part(device_, "images");
    ensure_size(device_, picture_, "picture", pixels_of(settings) * 16);
    ensure_size(device_, encoded_, "encoded picture", pixels_of(settings) * 4);
    has_unlit_ = unlit;
    open_ = open;
    if (unlit) ensure_size(device_, unlit_, "unlit colours", pixels_of(settings) * sizeof(glm::vec3));
    if (settings.moments) ensure_size(device_, moments_, "moments", pixels_of(settings) * sizeof(glm::vec2));
    if (!denoises) denoiser_.reset();
    if (denoises && !denoiser_) denoiser_ = std::make_unique<Denoiser>(device_);
    if (denoiser_) denoiser_->prepare(settings);
}

void PictureOutput::record_accumulation(Commands& commands, const PathQueues& queues, const Buffer& frame,
                                        const LevelParams& p, const PictureSettings& settings) {
    const bool encodes =
        settings.encoded && !open_ && !denoiser_ && post_passes_.empty() && p.sample_index + 1 == settings.spp;
    commands.run(device_.pass("accumulate", {{"has_unlit", has_unlit_}, {"has_moments", settings.moments}}),
                 {{"frame", frame},
                  {"nodes", queues.level(0).nodes},
                  {"branches", queues.level(0).branches},
                  {"next_nodes", queues.level(1).nodes},
                  {"shadow_light", queues.lights().light},
                  {"queue", queues.counters()},
                  {"picture", picture_},
                  {"encoded", encoded_},
                  unlit(),
                  Binding::if_used("moments", settings.moments ? &moments_ : nullptr)},
                 AccumulateParams{p.capacity, p.next_capacity, p.light_capacity, p.first_row, p.sample_index, encodes,
                                  scale_of(settings), 1 / float(settings.spp), uint32_t(settings.tonemap),
                                  settings.clamp.value_or(std::numeric_limits<float>::max()),
                                  settings.backdrop.is_transparent()},
                 groups_for(p.capacity, 64));
}

void PictureOutput::record_memory(Commands& commands, const PictureSettings& settings) {
    if (denoiser_) denoiser_->record_memory(commands, settings);
}

bool PictureOutput::record_post(Commands& commands, const PictureSettings& settings) {
    const bool posts = !post_passes_.empty();
    if (!posts && !open_ && !denoiser_) return false;
    if (denoiser_) denoiser_->record_filter(commands, picture_, settings);
    if (posts && has_unlit_)
        commands.run(device_.pass("unlit_share"), {{"picture", picture_}, {"unlit", unlit_}},
                     uint32_t(pixels_of(settings)), groups_for(pixels_of(settings), 64));
    for (const PostPass& pass : post_passes_) pass(commands, picture_, settings);
    if (settings.encoded) record_encoding(commands, settings, posts);
    return true;
}

/// `shares`: of unlit colours there are shares of the picture, else sums.
void PictureOutput::record_encoding(Commands& commands, const PictureSettings& settings, bool shares) const {
    const uint64_t pixels = pixels_of(settings);
    commands.run(device_.pass("encode", {{"has_unlit", has_unlit_}}),
                 {{"picture", picture_}, {"encoded", encoded_}, unlit()},
                 EncodeParams{uint32_t(pixels), scale_of(settings), 1 / float(settings.spp), uint32_t(settings.tonemap),
                              shares, settings.backdrop.is_transparent()},
                 groups_for(pixels, 64));
}

void PictureOutput::download_picture(Commands& commands, const PictureSettings& settings, Picture& out) const {
    out.width = settings.width;
    out.height = settings.height;
    out.transparent = settings.backdrop.is_transparent();
    out.radiance.resize(settings.radiance ? pixels_of(settings) : 0);
    out.encoded.resize(settings.encoded ? pixels_of(settings) : 0);
    if (settings.radiance) download_radiance(commands, settings, out);
    if (settings.encoded) commands.download_into(encoded_, out.encoded);
}

void PictureOutput::download_radiance(Commands& commands, const PictureSettings& settings, Picture& out) const {
    out.radiance.resize(pixels_of(settings));
    commands.download_into(picture_, out.radiance);
    if (settings.spp == 1) return;
    for (glm::vec4& pixel : out.radiance) pixel /= float(settings.spp);
}

double PictureOutput::seen(Commands& commands, const PictureSettings& settings) {
    ensure_size(device_, seen_rows_, "what is seen in each row", settings.height * sizeof(float));
    commands.run(device_.pass("seen_rows"), {{"picture", picture_}, {"rows", seen_rows_}},
                 glm::uvec2(settings.width, settings.height), groups_for(settings.height, 1));
    double sum = 0;
    for (const float row : commands.download<float>(seen_rows_, settings.height)) sum += double(row);
    return sum / (double(pixels_of(settings)) * settings.spp);
}

void PictureOutput::download(Commands& commands, const PictureSettings& settings, Picture& out) {
    download_picture(commands, settings, out);
    out.seen.reset();
    if (settings.seen && !settings.radiance) out.seen = seen(commands, settings);
    if (!settings.moments) return;
    for (const glm::vec2& moments : commands.download<glm::vec2>(moments_, pixels_of(settings)))
        out.aovs.variance.push_back(variance_of_mean(moments.y, settings.spp));
    out.aovs.sample_count.assign(pixels_of(settings), float(settings.spp));
}

Picture PictureOutput::look(Commands& commands, const PictureSettings& settings) const {
    record_encoding(commands, settings, false);
    commands.submit();
    Picture picture;
    download_picture(commands, settings, picture);
    return picture;
}

float PictureOutput::noise(Commands& commands, const PictureSettings& settings) const {
    const auto sums = commands.download<glm::vec4>(picture_, pixels_of(settings));
    const auto moments = commands.download<glm::vec2>(moments_, pixels_of(settings));
    std::vector<PixelMoments> pixels;
    for (size_t i = 0; i < sums.size(); i++)
        if (sums[i].w > 0) pixels.push_back({moments[i].x, variance_of_mean(moments[i].y, settings.spp)});
    return noise_of(pixels);
}

}  // namespace peelray
