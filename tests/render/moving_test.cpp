// Pictures of scenes that move: nothing is left of the moments before, only what must be is rebuilt, and what moves is
// in the mirror of the same frame.
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "effort.h"
#include "loaders/load.h"
#include "motion/animation.h"
#include "motion/bounds.h"
#include "moving.h"
#include "scene/tangents.h"

namespace peelray {
namespace {

using glm::vec3;
using Path = AnimationChannel::Path;

class MovingTest : public PictureTest {
  protected:
    /// A renderer of a scene in a moment, as the command line makes it.
    std::unique_ptr<Renderer> renderer_in(const Scene& scene, const std::string& which, double time,
                                          const Environment& environment) {
        const Assembly assembly = assemble(scene, moment_of(scene, which, 0), motion_of(scene, which));
        return std::make_unique<Renderer>(device(), scene, moment_of(scene, which, time), assembly, environment);
    }
    RenderResult at(Renderer& renderer, const Scene& scene, const std::string& which, double time,
                    const RenderSettings& settings) {
        renderer.pose(moment_of(scene, which, time));
        return renderer.render(settings);
    }
    static RenderSettings small(const Camera& camera, HitTest hit = HitTest::exact) {
        RenderSettings settings = settings_for(camera, 48);
        settings.cubes.ldc = 0;
        settings.cubes.hit = hit;
        if (hit == HitTest::planar) settings.cubes.ldc = 128;
        return settings;
    }
    static void expect_identical(const RenderResult& a, const RenderResult& b) {
        ASSERT_EQ(a.radiance.size(), b.radiance.size());
        EXPECT_EQ(std::memcmp(a.radiance.data(), b.radiance.data(), a.radiance.size() * sizeof(glm::vec4)), 0);
        EXPECT_EQ(a.encoded, b.encoded);
        EXPECT_EQ(a.rays.secondary(), b.rays.secondary());
    }
    const Environment sky = sky_environment(default_sun_direction());
};

/// A mirror floor with a ball that a node moves, one that morphs and one that stands still.
Scene three_balls() {
    Scene scene;
    scene.name = "three balls";
    Material mirror = metal("mirror", vec3(0.9f)), red = matte("red", {0.8f, 0.1f, 0.1f}),
             blue = matte("blue", {0.1f, 0.1f, 0.8f}), green = matte("green", {0.1f, 0.7f, 0.1f});
    scene.materials = {mirror, red, blue, green};
    const auto add = [&](Primitive shape, uint32_t material, const vec3& at) {
        shape.material = material;
        scene.meshes.push_back({"mesh", {std::move(shape)}, {}});
        Node node;
        node.mesh = int(scene.meshes.size()) - 1;
        node.fixed = false;
        node.rest.translation = at;
        node.local = node.rest.matrix();
        scene.nodes.push_back(node);
        return int(scene.nodes.size()) - 1;
    };
    add(parallelogram({-3, 0, 3}, {6, 0, 0}, {0, 0, -6}), 0, {0, 0, 0});
    const int moving = add(sphere({0, 0, 0}, 0.5f, 10), 1, {-1.5f, 0.6f, 0});
    Primitive soft = sphere({0, 0, 0}, 0.5f, 10);
    soft.targets.push_back({{}, {}});
    for (const vec3& p : soft.positions) soft.targets[0].positions.push_back(vec3(0.4f * p.x, 1.2f * p.y, 0));
    const int morphing = add(std::move(soft), 2, {1.5f, 1.3f, 0});
    add(sphere({0, 0, 0}, 0.4f, 10), 3, {0, 0.5f, -1});
    scene.animations.push_back(
        {"both",
         2,
         {{moving,
           Path::translation,
           AnimationChannel::Interpolation::linear,
           3,
           {0, 2},
           {-1.5f, 0.6f, 0, 0.5f, 1.6f, 1}},
          {morphing, Path::weights, AnimationChannel::Interpolation::linear, 1, {0, 1, 2}, {0, 1, 0}}}});
    return scene;
}
const Camera kUsualView = [] {
    Camera camera;
    camera.eye = {0.5f, 2, 5};
    camera.look = {0, 0.5f, 0};
    return camera;
}();

TEST_F(MovingTest, AFrameIsTheSameAloneAndAfterOthers) {
    struct Case {
        const char* name;
        std::vector<double> times;
    };
    for (const Case& c : {Case{"", {0, 0.5, 1.1, 2}}, Case{"builtin:blob:2000", {0.1, 1, 1.9}},
                          Case{"builtin:waves:800", {0.2, 0.9, 0.5}}, Case{"builtin:particles:200", {0, 1.3, 4}}})
        for (const HitTest hit : {HitTest::exact, HitTest::planar}) {
            if (*c.name && hit == HitTest::planar && test::effort(true, false)) continue;
            SCOPED_TRACE(c.name);
            Scene scene = *c.name ? load_scene(c.name) : three_balls(),
                  other = *c.name ? load_scene(c.name) : three_balls();
            complete_targets(scene);
            complete_targets(other);
            const RenderSettings settings = small(scene.cameras.empty() ? kUsualView : scene.cameras[0], hit);
            const auto renderer = renderer_in(scene, "0", c.times.back(), sky);
            std::vector<RenderResult> first;
            for (const double time : c.times) first.push_back(at(*renderer, scene, "0", time, settings));
            for (size_t i = 0; i < c.times.size(); i++) {
                SCOPED_TRACE(c.times[i]);
                expect_identical(at(*renderer, scene, "0", c.times[i], settings), first[i]);
                const auto fresh = renderer_in(other, "0", c.times[i], sky);
                RenderSettings with_bounds = settings;
                expect_identical(fresh->render(with_bounds), first[i]);
            }
            size_t different = 0;
            for (size_t i = 0; i < first[0].radiance.size(); i++)
                different += first[0].radiance[i] != first[1].radiance[i];
            EXPECT_GT(different, 20u) << "something moves";
        }
}

TEST_F(MovingTest, LookingBackChangesNothingElse) {
    for (const char* name : {"", "builtin:waves:800", "builtin:particles:200"}) {
        SCOPED_TRACE(name);
        Scene scene = *name ? load_scene(name) : three_balls();
        RenderSettings plain = small(scene.cameras.empty() ? kUsualView : scene.cameras[0]);
        plain.aovs = true;
        RenderSettings looking = plain;
        looking.motion = true;
        looking.camera_before = looking.camera;
        const auto never = renderer_in(scene, "0", 0, sky), always = renderer_in(scene, "0", 0, sky);
        // On, and back.
        for (const double time : {0.4, 0.5, 0.2}) {
            SCOPED_TRACE(time);
            const Moment before = moment_of(scene, "0", time - 0.1);
            looking.moment_before = &before;
            const RenderResult one = at(*never, scene, "0", time, plain),
                               other = at(*always, scene, "0", time, looking);
            expect_identical(one, other);
            EXPECT_EQ(one.stats.moved, other.stats.moved);
            EXPECT_EQ(one.stats.rebuilt, other.stats.rebuilt);
            EXPECT_EQ(one.stats.frame_bytes, other.stats.frame_bytes);
            EXPECT_EQ(one.aovs.motion, std::vector<glm::vec2>(48 * 48, glm::vec2(0)));
            EXPECT_GT(std::ranges::count_if(other.aovs.motion, [](const auto& v) { return glm::length(v) > 0.05f; }),
                      20);
            if (time > 0.2) continue;
            const RenderResult again = always->render(looking);
            expect_identical(one, again);
            EXPECT_EQ(again.aovs.motion, other.aovs.motion);
            EXPECT_EQ(renderer_in(scene, "0", time, sky)->render(looking).aovs.motion, other.aovs.motion);
        }
    }
}

TEST_F(MovingTest, OnlyWhatChangesItsShapeIsRebuilt) {
    Scene scene = three_balls();
    const auto renderer = renderer_in(scene, "0", 0, sky);
    const RenderSettings settings = small(kUsualView);
    const RenderStats first = renderer->render(settings).stats;
    // The floor with the ball that stands on it (or apart), the ball that moves, the one that morphs.
    EXPECT_GE(first.cubes.bodies, 3u);
    EXPECT_EQ(first.cubes.fixed, first.cubes.bodies - 1);
    EXPECT_EQ(first.rebuilt, first.cubes.bodies) << "the first frame builds all";
    for (const double time : {0.5, 1.0}) {
        const RenderStats next = at(*renderer, scene, "0", time, settings).stats;
        EXPECT_EQ(next.rebuilt, 1u);
        EXPECT_EQ(next.moved, 1u);
    }
    const RenderStats same = at(*renderer, scene, "0", 1.0, settings).stats;
    EXPECT_EQ(same.moved, 0u) << "nothing moved since";
    RenderSettings all = settings;
    all.rebuild = true;
    EXPECT_EQ(at(*renderer, scene, "0", 0.5, all).stats.rebuilt, first.cubes.bodies);
    EXPECT_EQ(at(*renderer, scene, "0", 1.0, all).stats.rebuilt, first.cubes.bodies);
}

TEST_F(MovingTest, RebuildingEverythingChangesNoPicture) {
    for (const char* name : {"", "builtin:waves:800"}) {
        Scene scene = *name ? load_scene(name) : three_balls();
        RenderSettings settings = small(scene.cameras.empty() ? kUsualView : scene.cameras[0]);
        settings.cubes.ldc = 64;  // automatic resolutions are others where everything is rebuilt
        const auto renderer = renderer_in(scene, "0", 0.7, sky);
        const RenderResult kept = renderer->render(settings);
        settings.rebuild = true;
        expect_identical(renderer->render(settings), kept);
    }
}

TEST_F(MovingTest, AMomentLooksLikeTheSameSceneStandingStill) {
    // The mirror image and the shadow of what moves are those of this frame: the picture is that of the flattened
    // scene.
    for (const double time : {0.4, 1.2, 2.0}) {
        Scene scene = three_balls();
        const auto renderer = renderer_in(scene, "0", 0, sky);
        RenderSettings settings = small(kUsualView);
        settings.width = settings.height = 96;
        renderer->render(settings);
        const RenderResult moved = at(*renderer, scene, "0", time, settings);
        const Moment moment = moment_of(scene, "0", time);
        const Geometry geometry = flatten(scene, moment);
        Scene still;
        still.materials = scene.materials;
        Node node;
        node.mesh = 0;
        still.nodes.push_back(node);
        still.meshes.push_back({"all", {}, {}});
        for (const Geometry::Object& object : geometry.objects) {
            Primitive shape;
            shape.positions = geometry.positions;
            shape.normals = geometry.normals;
            shape.uvs = geometry.uvs;
            shape.triangles.assign(geometry.triangles.begin() + object.first,
                                   geometry.triangles.begin() + object.first + object.count);
            shape.material = geometry.materials[object.first];
            still.meshes[0].primitives.push_back(std::move(shape));
        }
        const Moment rest = at_rest(still);
        Renderer other(device(), still, rest, assemble(still, rest, motion_of(still, "")), sky);
        settings.bounds = bounds(scene, moment);
        Tally result = tally(moved, other.render(settings), 2e-3);
        result.expect(0.01, 96 * 96);  // at edges rounding decides
    }
}

TEST_F(MovingTest, HolesMoveWithWhatDeforms) {
    for (const HitTest hit : {HitTest::exact, HitTest::planar}) {
        SCOPED_TRACE(int(hit));
        Stage stage;
        stage.scene = three_balls();
        Scene& scene = stage.scene;
        for (const int material : {1, 2})
            scene.materials[size_t(material)] = masked(stage, scene.materials[size_t(material)]);
        // Spheres without texture coordinates: the same as their positions.
        for (Mesh& mesh : scene.meshes)
            for (Primitive& primitive : mesh.primitives) {
                primitive.uvs.clear();
                for (const vec3& p : primitive.positions) primitive.uvs.emplace_back(p.x + 0.3f * p.z, p.y);
            }
        const auto renderer = renderer_in(scene, "0", 0, sky);
        RenderSettings settings = small(kUsualView, hit);
        settings.width = settings.height = 96;
        if (hit == HitTest::planar) settings.cubes.ldc = 256;
        const RenderResult moved = at(*renderer, scene, "0", 1.2, settings);
        RenderSettings reference = settings;
        reference.cubes.hit = HitTest::exact;
        reference.cubes.ldc = 64;
        Scene still = scene;
        still.animations.clear();
        const Moment moment = moment_of(scene, "0", 1.2);
        reference.bounds = settings.bounds = bounds(scene, moment);
        Renderer other(device(), still, moment, assemble(still, moment, motion_of(still, "")), sky);
        tally(moved, other.render(reference), 5e-3).expect(hit == HitTest::exact ? 0.002 : 0.05, 96 * 96);
        for (Material& material : still.materials) material.alpha_cutoff = 0;
        Renderer opaque(device(), still, moment, assemble(still, moment, motion_of(still, "")), sky);
        EXPECT_GT(tally(moved, opaque.render(reference), 5e-3).wrong, 500u) << "the holes are seen";
    }
}

TEST_F(MovingTest, BentNormalsMoveWithWhatDeforms) {
    Stage stage;
    stage.scene = three_balls();
    Scene& scene = stage.scene;
    Texture waves;  // normals of all directions within 40 degrees
    waves.width = waves.height = 16;
    for (int i = 0; i < 256; i++) {
        const double a = 0.6 * std::sin(i * 0.7), b = 0.6 * std::sin(i * 1.9);
        const vec3 n = glm::normalize(vec3(float(a), float(b), 1)) * 127.5f + 127.5f;
        waves.texels.push_back(0xff000000u | uint32_t(n.x) | uint32_t(n.y) << 8 | uint32_t(n.z) << 16);
    }
    scene.textures.push_back(waves);
    for (Material& material : scene.materials) material.normal_texture = int(scene.textures.size()) - 1;
    for (Mesh& mesh : scene.meshes)
        for (Primitive& primitive : mesh.primitives) {
            primitive.uvs.clear();
            for (const vec3& p : primitive.positions) primitive.uvs.emplace_back(p.x + 0.3f * p.z, p.y);
        }
    complete_tangents(scene);
    for (Mesh& mesh : scene.meshes)
        for (Primitive& primitive : mesh.primitives)
            for (MorphTarget& target : primitive.targets)
                target.tangents.assign(primitive.positions.size(), vec3(0.2f));
    const auto renderer = renderer_in(scene, "0", 0, sky);
    RenderSettings settings = small(kUsualView);
    settings.width = settings.height = 96;
    const RenderResult moved = at(*renderer, scene, "0", 1.2, settings);
    Scene still = scene;
    still.animations.clear();
    const Moment moment = moment_of(scene, "0", 1.2);
    settings.bounds = bounds(scene, moment);
    Renderer other(device(), still, moment, assemble(still, moment, motion_of(still, "")), sky);
    tally(moved, other.render(settings), 5e-3).expect(0.005, 96 * 96);
    for (Material& material : still.materials) material.normal_texture = {};
    Renderer smooth(device(), still, moment, assemble(still, moment, motion_of(still, "")), sky);
    EXPECT_GT(tally(moved, smooth.render(settings), 5e-3).wrong, 1000u) << "the bent normals are seen";
}

TEST_F(MovingTest, HundredsOfFramesLoseNothingAndKeepNoMemory) {
    // A soup that spreads and draws together again: its samples, nodes and cells grow and shrink by orders of
    // magnitude.
    Scene scene;
    scene.name = "soup";
    scene.materials = {metal("mirror", vec3(0.9f))};
    Primitive shape;
    std::mt19937 random(5);
    const auto unit = [&] { return float(random() >> 8) / 16777216.0f; };
    MorphTarget spread;
    for (uint32_t i = 0; i < 600; i++) {
        const vec3 centre = 0.2f * vec3(unit() - 0.5f, unit() - 0.5f, unit() - 0.5f);
        for (int k = 0; k < 3; k++) {
            const vec3 corner = vec3(unit() - 0.5f, unit() - 0.5f, unit() - 0.5f);
            shape.positions.push_back(centre + 0.01f * corner);
            shape.normals.push_back({0, 1, 0});
            spread.positions.push_back(9.0f * centre + 0.8f * corner);
        }
        shape.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    // One that always reaches as far: the cube's box stays, what fills it does not.
    for (const vec3& corner : {vec3(-2), vec3(2), vec3(-2, 2, -2)}) {
        shape.positions.push_back(corner);
        shape.normals.push_back({0, 1, 0});
        spread.positions.push_back(vec3(0));
    }
    shape.triangles.push_back({1800, 1801, 1802});
    shape.targets.push_back(spread);
    shape.flat = true;
    scene.meshes.push_back({"soup", {shape}, {}});
    scene.nodes.resize(1);
    scene.nodes[0].mesh = 0;
    scene.animations.push_back(
        {"", 2, {{0, Path::weights, AnimationChannel::Interpolation::linear, 1, {0, 1, 2}, {0, 1, 0}}}});
    RenderSettings settings = small(perspective({0, 0.5f, 6}, {0, 0, 0}, 40));
    settings.width = settings.height = 16;
    settings.cubes.ldc = 128;
    settings.bounces = 1;
    settings.bounds = Box{vec3(-2), vec3(2)};
    const auto renderer = renderer_in(scene, "0", 0, sky);
    std::vector<uint32_t> samples;
    std::vector<RenderResult> half(60);
    uint64_t held = 0;
    uint32_t redone = 0;
    for (int frame = 0; frame < test::effort(120, 300); frame++) {
        RenderResult result = at(*renderer, scene, "0", frame % 60 / 30.0, settings);
        redone += result.stats.redone;
        samples.push_back(result.stats.cubes.counts.fragments);
        EXPECT_EQ(result.stats.cubes.counts.invalid, 0u);
        if (frame == 59) held = device().allocated();
        if (frame >= 60) {
            ASSERT_EQ(device().allocated(), held) << "frame " << frame;
            ASSERT_EQ(result.stats.redone, 0u) << "frame " << frame;
            expect_identical(result, half[size_t(frame % 60)]);
            ASSERT_EQ(samples[size_t(frame)], samples[size_t(frame) - 60]);
        } else {
            half[size_t(frame)] = std::move(result);
        }
        if (HasFatalFailure() || HasNonfatalFailure()) return;
    }
    EXPECT_GT(redone, 0u) << "it did overflow";
    EXPECT_GT(*std::max_element(samples.begin(), samples.end()), 4 * *std::min_element(samples.begin(), samples.end()));
    // What a cube holds at its largest is what one that is built alone holds.
    Scene alone = scene;
    const auto fresh = renderer_in(alone, "0", 1, sky);
    EXPECT_EQ(fresh->render(settings).stats.cubes.counts.fragments, *std::max_element(samples.begin(), samples.end()));
}

TEST_F(MovingTest, LightsAndCamerasGoWithTheirNodes) {
    Scene scene = three_balls();
    scene.lights.resize(1);
    scene.lights[0].kind = Light::Kind::point;
    scene.lights[0].color = vec3(20);
    scene.nodes[1].light = 0;
    scene.nodes[1].mesh = -1;  // a lamp in place of the ball
    const auto renderer = renderer_in(scene, "0", 0, black);
    RenderSettings settings = small(kUsualView);
    const RenderResult before = renderer->render(settings), after = at(*renderer, scene, "0", 2, settings);
    size_t different = 0;
    for (size_t i = 0; i < before.radiance.size(); i++) different += before.radiance[i] != after.radiance[i];
    EXPECT_GT(different, 150u);
    const auto fresh = renderer_in(scene, "0", 2, black);
    expect_identical(fresh->render(settings), after);
}

TEST_F(MovingTest, TheBaselinesMoveToo) {
    Scene scene = three_balls();
    for (const Tracer tracer : {Tracer::cubemap, Tracer::none}) {
        RenderSettings settings = small(kUsualView);
        settings.tracer = tracer;
        const auto renderer = renderer_in(scene, "0", 0, sky);
        renderer->render(settings);
        const RenderResult moved = at(*renderer, scene, "0", 1.3, settings);
        const auto fresh = renderer_in(scene, "0", 1.3, sky);
        expect_identical(fresh->render(settings), moved);
    }
}

TEST_F(MovingTest, WaterTooFarFromItsBeginningIsRefused) {
    Scene scene = load_scene("builtin:waves:200");
    const auto renderer = renderer_in(scene, "0", 0, sky);
    expect_error([&] { renderer->pose(moment_of(scene, "0", 4000)); }, {"3600", "4000"});
}

TEST_F(MovingTest, WhatIsReflectedByItsNodeKeepsItsFront) {
    // Balls whose nodes reflect them after half of the animation: one moves as a body, one morphs, one has a skin. A
    // ball is the same from outside with and without its backs, at first and after the camera came back to a moment.
    Scene scene = three_balls();
    for (AnimationChannel& channel : scene.animations[0].channels)
        if (channel.path == Path::translation) {
            channel.path = Path::scale;
            channel.values = {1, 1, 1, -1, 1, 1};
        }
    const auto scale = [&](int node) {
        scene.animations[0].channels.push_back(
            {node, Path::scale, AnimationChannel::Interpolation::linear, 3, {0, 2}, {1, 1, 1, 1, 1, -1}});
    };
    scale(2);
    Primitive soft = sphere({0, 0, 0}, 0.3f, 8);
    soft.material = 3;
    for (size_t k = 0; k < soft.positions.size(); k++) {
        soft.joints.emplace_back();
        soft.joints.back().weights[0] = 1;
    }
    scene.meshes.push_back({"skinned", {soft}, {}});
    Node skinned, joint;
    skinned.mesh = int(scene.meshes.size()) - 1;
    skinned.skin = 0;
    joint.fixed = false;
    joint.rest.translation = {0.2f, 0.4f, 1.5f};
    joint.local = joint.rest.matrix();
    scene.nodes.push_back(skinned);
    scene.nodes.push_back(joint);
    scene.skins.push_back({"skin", {int(scene.nodes.size()) - 1}, {glm::mat4(1)}});
    scale(int(scene.nodes.size()) - 1);
    Scene single = scene;
    for (Material& material : single.materials) material.double_sided = false;
    for (const Visibility visibility : {Visibility::raster, Visibility::compute}) {
        RenderSettings settings = small(perspective({1, 2.5f, 4}, {0, 0.6f, 0}, 50));
        settings.visibility = visibility;
        const auto moving = renderer_in(single, "0", 0, sky);
        for (const double time : {0.3, 1.7, 0.6}) {
            SCOPED_TRACE(time);
            const RenderResult expected = renderer_in(scene, "0", time, sky)->render(settings);
            tally(renderer_in(single, "0", time, sky)->render(settings), expected, 1e-5).expect(0.003, 48 * 48);
            tally(at(*moving, single, "0", time, settings), expected, 1e-5).expect(0.003, 48 * 48);
        }
    }
}

}  // namespace
}  // namespace peelray
