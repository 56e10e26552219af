// glTF 2.0, section 3.11 (animations) and appendix C (interpolation).
#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <utility>

#include "base/error.h"
#include "motion/animation.h"
#include "motion/motion.h"

namespace peelray {
namespace {

using Path = AnimationChannel::Path;
using Interpolation = AnimationChannel::Interpolation;

glm::quat quaternion(const float* v) {
    return {v[3], v[0], v[1], v[2]};
}

/// Between two rotations along the shorter way.
void slerp(const float* from, const float* to, float share, std::vector<float>& out) {
    const glm::quat q = glm::slerp(quaternion(from), quaternion(to), share);
    out = {q.x, q.y, q.z, q.w};
}

void make_unit(std::vector<float>& rotation) {
    double length2 = 0;
    for (const float v : rotation) length2 += double(v) * v;
    const double length = std::sqrt(length2);
    if (!(length > 1e-12) || !std::isfinite(length)) {
        rotation = {0, 0, 0, 1};
        return;
    }
    for (float& v : rotation) v = float(v / length);
}

void apply(const AnimationChannel& channel, float time, Moment& moment, std::vector<Placement>& placements) {
    const std::vector<float> v = channel.at(time);
    Placement& placement = placements[size_t(channel.node)];
    switch (channel.path) {
        case Path::translation:
            placement.translation = {v[0], v[1], v[2]};
            break;
        case Path::rotation:
            placement.rotation = quaternion(v.data());
            break;
        case Path::scale:
            placement.scale = {v[0], v[1], v[2]};
            break;
        case Path::weights:
            moment.weights[size_t(channel.node)] = v;
            break;
    }
}

/// Is the animation that drives what is generated among these?
bool generates(const Scene& scene, const std::vector<const Animation*>& animations) {
    return std::any_of(animations.begin(), animations.end(), [&](const Animation* animation) {
        return animation - scene.animations.data() == scene.generated.animation;
    });
}

/// Does the channel ever change what it sets? Exporters write many that do not.
bool varies(const AnimationChannel& channel) {
    const bool cubic = channel.interpolation == Interpolation::cubic;
    const size_t width = channel.width, stride = width * (cubic ? 3 : 1);
    for (size_t i = 0; i < channel.values.size(); i++) {
        const bool tangent = cubic && i % stride / width != 1;
        if (channel.values[i] != (tangent ? 0 : channel.values[(cubic ? width : 0) + i % width])) return true;
    }
    return false;
}

#ifndef NDEBUG
bool has_all_targets(const Scene& scene) {
    for (const Mesh& mesh : scene.meshes)
        for (const Primitive& primitive : mesh.primitives)
            if (primitive.make_targets) return false;
    return true;
}
#endif

}  // namespace

std::vector<float> AnimationChannel::at(float time) const {
    const bool cubic = interpolation == Interpolation::cubic;
    const size_t stride = width * (cubic ? 3 : 1);
    const auto value = [&](size_t key) { return &values[key * stride + (cubic ? width : 0)]; };
    // The last key that is not later than the time.
    const size_t next = size_t(std::upper_bound(times.begin(), times.end(), time) - times.begin());
    const size_t key = next == 0 ? 0 : next - 1;
    std::vector<float> out(value(key), value(key) + width);
    if (next > 0 && next < times.size() && interpolation != Interpolation::step) {
        const float step = times[next] - times[key], s = (time - times[key]) / step;
        const float *a = value(key), *b = value(next);
        if (cubic) {
            // Hermite's basis; tangents are per second.
            const float s2 = s * s, s3 = s2 * s;
            const float *leaving = a + width, *arriving = b - width;
            for (uint32_t i = 0; i < width; i++)
                out[i] = (2 * s3 - 3 * s2 + 1) * a[i] + step * (s3 - 2 * s2 + s) * leaving[i] +
                         (3 * s2 - 2 * s3) * b[i] + step * (s3 - s2) * arriving[i];
        } else if (path == Path::rotation) {
            slerp(a, b, s, out);
        } else {
            for (uint32_t i = 0; i < width; i++) out[i] = a[i] + s * (b[i] - a[i]);
        }
    }
    if (path == Path::rotation) make_unit(out);
    return out;
}

std::vector<const Animation*> find_animations(const Scene& scene, const std::string& which) {
    const std::vector<Animation>& list = scene.animations;
    if (list.empty())
        fail("{}: the scene has no animation: leave {} and {} out", scene.name, setting::time, setting::animation);
    if (which == "all") {
        std::vector<const Animation*> all;
        for (const Animation& animation : list) all.push_back(&animation);
        return all;
    }
    for (size_t i = 0; i < list.size(); i++)
        if (list[i].name == which) return {&list[i]};
    for (size_t i = 0; i < list.size(); i++)
        if (std::to_string(i) == which) return {&list[i]};
    std::string names;
    for (size_t i = 0; i < list.size(); i++)
        names += fmt::format("{}{}: {}", i ? ", " : "", i, list[i].name.empty() ? "(no name)" : list[i].name);
    fail("{}: the scene has no animation '{}': there is {} ({})", scene.name, which, names, setting::animation);
}

void complete_targets(Scene& scene) {
    for (Mesh& mesh : scene.meshes)
        for (Primitive& primitive : mesh.primitives)
            if (const auto make = std::exchange(primitive.make_targets, nullptr)) primitive.targets = make(primitive);
}

double moment_before(double time, double fps) {
    const double frame = time * fps, whole = std::round(frame);
    const double before = std::abs(frame - whole) < 1e-6 ? (whole - 1) / fps : time - 1 / fps;
    return std::max(before, 0.0);
}

Moment moment_of(const Scene& scene, const std::string& which, double time) {
    if (which.empty()) return at_rest(scene);
    const std::vector<const Animation*> animations = find_animations(scene, which);
    assert(has_all_targets(scene));
    Moment moment = at_rest(scene);
    std::vector<Placement> placements;
    placements.reserve(scene.nodes.size());
    for (const Node& node : scene.nodes) placements.push_back(node.rest);
    for (const Animation* animation : animations) {
        const double past =
            animation->duration > 0 && time > animation->duration ? std::fmod(time, animation->duration) : time;
        for (const AnimationChannel& channel : animation->channels) apply(channel, float(past), moment, placements);
    }
    for (size_t i = 0; i < scene.nodes.size(); i++)
        if (!scene.nodes[i].fixed) moment.locals[i] = placements[i].matrix(scene.precise);
    moment.worlds = world_matrices(scene, moment.locals);
    if (generates(scene, animations)) moment.generated_time = time;
    // As far ahead as at rest.
    carry_along(
        scene, moment, moment.cameras, moment.lights,
        [](const Camera& rest, const glm::dvec3&, const glm::dvec3&) { return glm::length(rest.look - rest.eye); });
    return moment;
}

Motion motion_of(const Scene& scene, const std::string& which) {
    const std::vector<bool> none(scene.nodes.size(), false);
    Motion motion{none, none, none};
    if (which.empty()) return motion;
    const std::vector<const Animation*> chosen = find_animations(scene, which);
    for (const Animation* animation : chosen)
        for (const AnimationChannel& channel : animation->channels) {
            if (!varies(channel)) continue;
            const auto node = size_t(channel.node);
            (channel.path == Path::weights ? motion.morphs : motion.moves)[node] = true;
            if (channel.path == Path::scale) motion.scales[node] = true;
        }
    for (size_t i = 0; i < scene.nodes.size(); i++)
        if (scene.nodes[i].is_instance) motion.morphs[i] = motion.morphs[size_t(scene.nodes[i].parent)];
    motion.generates = generates(scene, chosen);
    if (!motion.generates) return motion;
    for (const Water& water : scene.generated.waters)
        for (const Water::Float& f : water.floats) motion.moves[size_t(f.node)] = true;
    for (const Swarm& swarm : scene.generated.swarms)
        for (const int node : swarm.nodes) motion.moves[size_t(node)] = true;
    return motion;
}

}  // namespace peelray
