#include "workspace/camera_choice.h"

#include "base/error.h"

namespace peelray {
namespace {

const Camera& find_camera(const Scene& scene, const std::vector<Camera>& cameras, const std::string& name) {
    if (cameras.empty())
        fail("the scene '{}' has no cameras: leave {} out, or use {} and {}", scene.name, setting::camera, setting::eye,
             setting::look);
    std::string names;
    for (size_t i = 0; i < cameras.size(); i++) {
        if (cameras[i].name == name || std::to_string(i) == name) return cameras[i];
        names += fmt::format("{}{}: {}", i ? ", " : "", i, cameras[i].name.empty() ? "(no name)" : cameras[i].name);
    }
    fail("the scene '{}' has no camera '{}': there is {} ({})", scene.name, name, names, setting::camera);
}

}  // namespace

Camera choose_camera(const PictureArguments& a, const Scene& scene, const std::vector<Camera>& cameras,
                     const Box& box) {
    Camera camera = frame_box(box.lower, box.upper, float(a.size.x) / float(a.size.y));
    if (!a.camera.empty())
        camera = find_camera(scene, cameras, a.camera);
    else if (!a.eye && !a.look && !cameras.empty())
        camera = cameras.front();
    if (a.eye || a.look) camera.orthographic_height = 0;
    if (a.look || a.eye) camera.look = a.look.value_or(0.5f * (box.lower + box.upper));
    if (a.eye) camera.eye = *a.eye;
    if (a.up) camera.up = *a.up;
    if (a.fov) {
        camera.vertical_fov = *a.fov * 3.14159265f / 180;
        camera.orthographic_height = 0;
    }
    return camera;
}

}  // namespace peelray
