// From picture arguments to what every tracer renders: scene, triangles, camera, light.
#pragma once

#include "cli/program.h"
#include "scene/environment.h"

namespace peelray {

struct PreparedScene {
    Scene scene;
    Geometry geometry;
    Camera camera;
    Environment environment;
};

/// Throws Error for values that are well-formed but make no sense.
void check_ranges(const PictureArguments& arguments);
/// Settings for a hit test by its name: auto, exact or planar.
void choose_hit(RenderSettings& settings, const std::string& hit);
/// The settings without the camera and the tracer.
RenderSettings settings_of(const PictureArguments& arguments);
/// Loads the scene and applies --material, --floor, the camera and the light. Throws Error.
PreparedScene prepare_scene(const PictureArguments& arguments);

}  // namespace peelray
