#include "workspace/camera_choice.h"

#include <algorithm>

#include "base/error.h"
#include "scene/origin.h"

namespace peelray {
namespace {

std::string name_or_none(const Camera& camera) {
    return camera.name.empty() ? "(no name)" : camera.name;
}

/// "0: near, 1.0: flat, 1.1: flat": all that can be chosen.
std::string list_of(const std::vector<Camera>& cameras) {
    std::string names;
    for (size_t i = 0; i < cameras.size(); i++)
        names += fmt::format("{}{}: {}", i ? ", " : "", camera_label(cameras, i), name_or_none(cameras[i]));
    return names;
}

const Camera* find_placed(const std::vector<Camera>& cameras, const std::string& name) {
    for (const Camera& camera : cameras)
        if (camera.name == name) return &camera;
    for (const Camera& camera : cameras)
        if (camera.node == name) return &camera;
    for (size_t i = 0; i < cameras.size(); i++)
        if (camera_label(cameras, i) == name || std::to_string(cameras[i].number) == name) return &cameras[i];
    return nullptr;
}

const Camera& find_camera(const Scene& scene, const std::vector<Camera>& cameras, const std::string& name) {
    if (const Camera* found = find_placed(cameras, name)) return *found;
    const std::string instead =
        cameras.empty() ? fmt::format("leave {} out, or use {} and {}", setting::camera, setting::eye, setting::look)
                        : fmt::format("there is {} ({})", list_of(cameras), setting::camera);
    if (const Camera* unplaced = find_placed(scene.unplaced_cameras, name))
        fail("the scene '{}' shows its camera {} ({}) on no node, so that it has no place: {}", scene.name,
             unplaced->number, name_or_none(*unplaced), instead);
    if (cameras.empty()) fail("the scene '{}' has no cameras: {}", scene.name, instead);
    fail("the scene '{}' has no camera '{}': {}", scene.name, name, instead);
}

/// A point of the world in the coordinates of the scene; in single precision where that is fine enough.
glm::dvec3 in_scene(const glm::dvec3& point, const Scene& scene, const Box& box) {
    const glm::dvec3 p = point - scene.origin;
    const bool far = is_far(reach_of(p), reach_of(box.upper - box.lower));
    return scene.precise || far ? p : glm::dvec3(glm::vec3(p));
}

}  // namespace

std::string camera_label(const std::vector<Camera>& cameras, size_t index) {
    const uint32_t number = cameras[index].number;
    const auto is_same = [&](const Camera& camera) { return camera.number == number; };
    if (std::count_if(cameras.begin(), cameras.end(), is_same) == 1) return std::to_string(number);
    return fmt::format("{}.{}", number,
                       std::count_if(cameras.begin(), cameras.begin() + std::ptrdiff_t(index), is_same));
}

Framing::Lens framing_lens(const PictureArguments& a) {
    Framing::Lens lens;
    lens.aspect = float(a.size.x) / float(a.size.y);
    if (a.fov) lens.vertical_fov = glm::radians(*a.fov);
    if (a.up) lens.up = *a.up;
    return lens;
}

Camera choose_camera(const PictureArguments& a, const Scene& scene, const std::vector<Camera>& cameras,
                     const Framing& framing) {
    const Box& box = framing.box();
    Camera camera = framing.camera();
    if (!a.camera.empty())
        camera = find_camera(scene, cameras, a.camera);
    else if (!a.eye && !a.look && !cameras.empty())
        camera = cameras.front();
    if (a.eye || a.look) camera.orthographic_height = 0;
    if (a.look) camera.look = in_scene(*a.look, scene, box);
    if (a.eye && !a.look) camera.look = 0.5f * (box.lower + box.upper);
    if (a.eye) camera.eye = in_scene(*a.eye, scene, box);
    if (a.up) camera.up = *a.up;
    if (a.fov) {
        camera.vertical_fov = *a.fov * 3.14159265f / 180;
        camera.orthographic_height = 0;
    }
    return camera;
}

}  // namespace peelray
