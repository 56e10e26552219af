#include "workspace/environment_choice.h"

#include <utility>

#include "image/image.h"

namespace peelray {
namespace {

Environment own_environment(const LightArguments& a, const Scene& scene, const Notes& notes) {
    if (!a.env.empty()) {
        std::vector<std::string> texts;
        Image image = read_environment(a.env, texts);
        for (const std::string& text : texts) note(notes, text);
        return image_environment(image.width, image.height, std::move(image.pixels));
    }
    if (a.is_lit_by_background()) return color_environment(*a.background->color);
    if (scene.cube_light && !a.sky) return cube_environment(*scene.cube_light);
    // A scene that brings its own lights gets a sky without a sun's worth of extra light only if asked for.
    if (a.sky || (scene.lights.empty() && scene.outdoors)) return sky_environment(default_sun_direction());
    return scene.lights.empty() ? studio_environment() : color_environment(glm::vec3(0.05f));
}

}  // namespace

Environment choose_environment(const LightArguments& a, const Scene& scene, const Notes& notes) {
    Environment environment = own_environment(a, scene, notes);
    rotate(environment, a.env_rotation);
    scale(environment, a.env_intensity);
    if (a.visible() == EnvVisible::blurred) add_blurred(environment);
    return environment;
}

}  // namespace peelray
