#include "render/aov_pictures.h"

#include "base/error.h"
#include "view/view_params.h"

namespace peelray {

void AovPictures::render(FrameState& f, Aovs& aovs) {
    Device& device = f.device;
    const RenderSettings& settings = f.settings;
    const size_t pixels = size_t(settings.width) * settings.height;
    if (pixels * sizeof(AovSurface) > device.limits().maxStorageBufferRange)
        fail(
            "auxiliary pictures of {}x{} pixels need {:.0f} MiB at once, more than the device '{}' binds: choose a "
            "smaller {}",
            settings.width, settings.height, double(pixels) * sizeof(AovSurface) / (1 << 20), device.info().name,
            setting::size);
    const MemoryPart part(device, "images");
    ensure_size(device, buffer_, "auxiliary pictures", pixels * sizeof(AovSurface));
    if (settings.motion) motion_.prepare(f);
    f.commands.fill(f.queues.counters(), 0);
    f.view.record(f.commands, f.scene, f.queues, 0);  // it found room before
    for (uint32_t row = 0; row < settings.height; row += f.bands.rows()) {
        const LevelParams p = level_params(f, 0, 0, row);
        record_primary(f.commands, device, f.scene, f.view.target, f.queues, p, f.view.by_number());
        f.commands.run(device.pass("aov", {f.scene.base_colors.constant()}),
                       surface_bindings(f.scene, f.view.target.frame,
                                        {{"rays", f.queues.level(0).traced->rays},
                                         {"hits", f.queues.level(0).traced->hits},
                                         {"aovs", buffer_},
                                         {"triangle_ids", f.scene.triangle_ids},
                                         {"triangle_objects", f.scene.triangle_objects}}),
                       p, groups_for(p.capacity, 64));
        if (settings.motion) motion_.record(f, p);
    }
    f.commands.submit();
    const auto records = f.commands.download<AovSurface>(buffer_, pixels);
#define AOV_STORE(name, type, channels, nothing) \
    for (const AovSurface& record : records) aovs.name.push_back(record.name);
    SEEN_AOVS(AOV_STORE)
#undef AOV_STORE
    motion_.store(f, aovs);
}

/// The paper's Figure 7, in render targets.
void AovPictures::render_ray_setup(FrameState& f, const Box& box, Aovs& aovs) {
    Device& device = f.device;
    const RenderSettings& settings = f.settings;
    const MemoryPart part(device, "images");
    const uint32_t pixels = settings.width * settings.height;
    RasterSetup setup;
    setup.colors.assign(4, VK_FORMAT_R32G32B32A32_SFLOAT);
    setup.depth = VK_COMPARE_OP_ALWAYS;
    std::vector<Image2D> images;
    DrawTargets targets;
    for (size_t i = 0; i < setup.colors.size(); i++)
        images.emplace_back(device, "mirror rays", settings.width, settings.height, setup.colors[i],
                            VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT,
                            VK_IMAGE_ASPECT_COLOR_BIT);
    for (const Image2D& image : images) targets.colors.push_back(&image);
    targets.width = settings.width;
    targets.height = settings.height;
    const Buffer stored(device, "mirror rays", uint64_t(pixels) * sizeof(AovRaySetup));
    const RaySetupParams p{box.lower, box.upper};
    const DrawRange whole{0, 1, 0, 1};
    const Binding bindings[] = {{"frame", f.view.target.frame}, {"aovs", buffer_}};
    f.commands.draw(device.raster_pass("ray_setup", setup), bindings, p, std::span(&whole, 1), targets);
    f.commands.run(device.pass("ray_setup_store"),
                   {{"frame", f.view.target.frame},
                    {"ray_setups", stored},
                    {"reflection", images[0]},
                    {"box_point", images[1]},
                    {"directions_xy", images[2]},
                    {"directions_z", images[3]}},
                   pixels, groups_for(pixels, 64));
    f.commands.submit();
    const auto records = f.commands.download<AovRaySetup>(stored, pixels);
#define AOV_STORE(name, type, channels, nothing) \
    for (const AovRaySetup& record : records) aovs.name.push_back(record.name);
    RAY_SETUP_AOVS(AOV_STORE)
#undef AOV_STORE
}

}  // namespace peelray
