#include "render/view_passes.h"
#include "common/ray.h"

namespace peelray {

void ViewTarget::resize(Device& device, uint32_t width, uint32_t height) {
    if (color.width() == width && color.height() == height && visibility) return;
    color.reset();
    depth.reset();
    const MemoryPart part(device, "images");
    color = Image2D(device, "visibility", width, height, VK_FORMAT_R32G32_UINT,
                    VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT, VK_IMAGE_ASPECT_COLOR_BIT);
    depth = Image2D(device, "depth", width, height, VK_FORMAT_D32_SFLOAT, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT,
                    VK_IMAGE_ASPECT_DEPTH_BIT);
    ensure_size(device, visibility, "visible triangles", uint64_t(width) * height * sizeof(SurfaceId));
}

std::vector<Binding> surface_bindings(const GpuScene& scene, const Buffer& frame,
                                      std::initializer_list<Binding> others) {
    std::vector<Binding> bindings = {{"frame", frame},
                                     {"normals", scene.normals},
                                     {"positions", scene.triangles.positions},
                                     {"triangles", scene.triangles.triangles},
                                     {"instances", scene.instances.table()},
                                     Binding::if_used("lookups", scene.lookups)};
    for (const Binding& binding : base_color_bindings(scene.base_colors)) bindings.push_back(binding);
    for (const Binding& other : others) bindings.push_back(other);
    return bindings;
}

void record_primary(Commands& commands, Device& device, const GpuScene& scene, const ViewTarget& target,
                    PathQueues& queues, const LevelParams& params, bool by_number) {
    const PathLevel& level = queues.level(0);
    commands.run(device.pass("primary", {{"by_number", by_number}}),
                 {{"frame", target.frame},
                  {"positions", scene.triangles.positions},
                  {"triangles", scene.triangles.triangles},
                  {"visibility", target.visibility},
                  {"rays", level.traced->rays},
                  {"states", level.traced->states},
                  {"hits", level.traced->hits},
                  {"instances", scene.instances.table()},
                  {"draws", scene.draw_table}},
                 params, groups_for(params.capacity, 64));
}

}  // namespace peelray
