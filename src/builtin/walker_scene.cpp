// A figure that walks in a circle over a mirror, behind and in front of glass.

#include <glm/gtc/matrix_transform.hpp>

#include "builtin/shapes.h"
#include "builtin/walker_motion.h"

namespace peelray {

namespace {

constexpr int keys_per_stride = 48;

AnimationChannel channel(int node, AnimationChannel::Path path) {
    AnimationChannel out;
    out.node = node;
    out.path = path;
    out.width = path == AnimationChannel::Path::rotation ? 4 : 3;
    return out;
}

void add_key(AnimationChannel& channel, float time, const glm::vec3& value) {
    channel.times.push_back(time);
    channel.values.insert(channel.values.end(), {value.x, value.y, value.z});
}

void add_key(AnimationChannel& channel, float time, const glm::quat& value) {
    channel.times.push_back(time);
    channel.values.insert(channel.values.end(), {value.x, value.y, value.z, value.w});
}

/// Keys of all joints; `first` is the root's node. `pose` and `root` at a moment from 0 to 1.
template <typename Pose, typename Root>
Animation sampled(const char* name, float duration, int keys, int first, Pose pose, Root root) {
    Animation out{name, duration, {}};
    using Path = AnimationChannel::Path;
    out.channels = {channel(first, Path::translation), channel(first + int(Joint::hips), Path::translation)};
    for (int joint = 0; joint < int(joint_count); ++joint)
        out.channels.push_back(channel(first + joint, Path::rotation));
    for (int key = 0; key <= keys; ++key) {
        // The last key is the first one again, to the bit.
        const float share = float(key % keys) / float(keys), time = duration * float(key) / float(keys);
        const WalkerPose at = pose(share);
        const Placement placement = root(share);
        add_key(out.channels[0], time, placement.translation);
        add_key(out.channels[1], time, at.translation(Joint::hips));
        for (size_t joint = 0; joint < joint_count; ++joint)
            add_key(out.channels[2 + joint], time,
                    joint == 0 ? glm::quat(placement.rotation) : at.rotation(Joint(joint)));
    }
    return out;
}

/// Adds the skeleton, bound as walker_skin() is and standing at ease at `root`, and a node that shows the skin.
int add_figure(Scene& scene, const Placement& root, std::vector<Primitive> skin) {
    const auto first = int(scene.nodes.size());
    const WalkerPose pose = standing_pose();
    Skin bones{"walker", {}, {}};
    for (size_t i = 0; i < joint_count; ++i) {
        const JointPlace& joint = walker_joints()[i];
        Node node;
        node.name = joint.name;
        node.parent = i == 0 ? -1 : first + int(joint.parent);
        node.fixed = false;
        if (i == 0) {
            node.rest = root;
        } else {
            node.rest.translation = pose.translation(Joint(i));
            node.rest.rotation = pose.rotation(Joint(i));
        }
        node.local = node.rest.matrix();
        scene.nodes.push_back(node);
        bones.joints.push_back(first + int(i));
        bones.inverse_bind.push_back(glm::translate(glm::mat4(1), -joint.at));
    }
    Node shown;
    shown.name = "walker";
    shown.mesh = int(scene.meshes.size());
    shown.skin = int(scene.skins.size());
    scene.nodes.push_back(shown);
    scene.meshes.push_back({"walker", std::move(skin), {}});
    scene.skins.push_back(std::move(bones));
    return first;
}

/// A wall around the back of the stage: a part of a cylinder that opens towards +z.
Primitive curved_wall(float radius, float height, float degrees, uint32_t segments, float repeat) {
    Primitive out;
    for (uint32_t i = 0; i <= segments; ++i) {
        const float share = float(i) / float(segments), angle = glm::radians(degrees * (share - 0.5f));
        const glm::vec3 outwards(std::sin(angle), 0, -std::cos(angle));
        for (const float y : {0.f, height}) {
            out.positions.push_back(radius * outwards + glm::vec3(0, y, 0));
            out.normals.push_back(-outwards);
            out.uvs.push_back({repeat * share, y / height});
        }
        if (i == 0) continue;
        const uint32_t a = 2 * i - 2;
        out.triangles.push_back({a, a + 2, a + 3});
        out.triangles.push_back({a, a + 3, a + 1});
    }
    return out;
}

void add_stage(SceneBuilder& build) {
    Material floor = metal("polished floor", glm::vec3(1));
    floor.metallic = 0.85f;
    floor.base_color_texture = build.tiles(2, 0xB8B0A8, 0x9C9288, true);
    build.add("floor", parallelogram({-5, 0, 5}, {10, 0, 0}, {0, 0, -10}, 5), build.material(floor));
    Material wall = matte("striped wall", glm::vec3(1));
    wall.base_color_texture = build.tiles(2, 0xBEB288, 0xD8E4EA, false);
    build.add("wall", curved_wall(3.7f, 3.4f, 176, 96, 7), build.material(wall));

    const auto turned = [](const glm::vec3& at, float degrees) {
        return glm::rotate(glm::translate(glm::mat4(1), at), glm::radians(degrees), glm::vec3(0, 1, 0));
    };
    // A hair above the floor, so that no two faces share a plane.
    constexpr float lift = 0.004f;
    build.add("pane", box({-0.62f, 0, -0.03f}, {0.62f, 1.95f, 0.03f}),
              build.material(glass("pane", {0.55f, 0.88f, 0.80f}, 0.06f, 0.25f)), turned({0.05f, lift, -0.1f}, 12));
    build.add("glass ball", sphere({1.62f, 0.40f + lift, 1.30f}, 0.40f, 32),
              build.material(glass("clear glass", {0.90f, 0.97f, 0.95f}, 0.8f, 1)));
    build.add("glass block", box({-0.24f, 0, -0.24f}, {0.24f, 1.25f, 0.24f}),
              build.material(glass("rose glass", {0.96f, 0.55f, 0.52f}, 0.48f, 0.4f)),
              turned({-1.86f, lift, 0.15f}, 35));
    build.add("chrome ball", sphere({1.95f, 0.58f, -1.50f}, 0.58f, 24),
              build.material(metal("chrome", glm::vec3(0.92f))));

    const auto ball = [&](const char* name, const glm::vec3& color, const glm::vec3& at, float radius) {
        build.add(name, sphere(at + glm::vec3(0, radius + lift, 0), radius, 16), build.material(matte(name, color)));
    };
    ball("red ball", {0.62f, 0.05f, 0.04f}, {-1.62f, 0, -1.75f}, 0.32f);
    ball("blue ball", {0.05f, 0.16f, 0.55f}, {1.15f, 0, -2.3f}, 0.26f);
    const auto block = [&](const char* name, const glm::vec3& color, const glm::vec3& at, float degrees) {
        build.add(name, box({-0.17f, 0, -0.17f}, {0.17f, 0.34f, 0.17f}), build.material(matte(name, color)),
                  turned(at + glm::vec3(0, lift, 0), degrees));
    };
    block("green block", {0.10f, 0.42f, 0.12f}, {-1.05f, 0, -2.25f}, 20);
    block("yellow block", {0.85f, 0.52f, 0.04f}, {-0.62f, 0, -2.35f}, -14);
    block("violet block", {0.30f, 0.10f, 0.42f}, {-0.83f, 0.345f, -2.3f}, 6);
}

}  // namespace

Scene make_walker() {
    SceneBuilder build("builtin:walker");
    add_stage(build);
    std::vector<uint32_t> materials;
    for (const Material& material : walker_materials()) materials.push_back(build.material(material));
    build.camera({0.33f, 1.60f, 6.6f}, {0.09f, 0.82f, 0.0f}, 32.5f);
    Scene scene = build.take();
    const WalkPath path;
    const Placement rest = place_on_path(path, 0.125f);
    const int root = add_figure(scene, rest, walker_skin(materials.front()));
    scene.animations.push_back(sampled(
        "walk", path.duration(), path.strides * keys_per_stride, root,
        [&](float share) { return walking_pose(path, share * float(path.strides)); },
        [&](float share) { return place_on_path(path, share); }));
    scene.animations.push_back(sampled("wave", 0.9f, 24, root, waving_pose, [&](float) { return rest; }));
    return scene;
}

}  // namespace peelray
