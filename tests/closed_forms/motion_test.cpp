// The auxiliary pictures `motion` and `instance`: where known movements take known points in the picture, and numbers
// that stay.
#include <pictures.h>

#include <glm/gtc/matrix_transform.hpp>

namespace peelray {
namespace {

using Path = AnimationChannel::Path;
using Interpolation = AnimationChannel::Interpolation;

/// Where a camera sees a point: pixels from the left and from the bottom.
glm::dvec2 place(const Camera& camera, double width, double height, const glm::dvec3& point) {
    const glm::dvec3 eye = camera.eye, forward = glm::normalize(glm::dvec3(camera.look) - eye);
    const glm::dvec3 right = glm::normalize(glm::cross(forward, glm::dvec3(camera.up))),
                     up = glm::cross(right, forward), p = point - eye;
    const bool flat = camera.orthographic_height > 0;
    const double half =
        flat ? camera.orthographic_height / 2 : std::tan(double(camera.vertical_fov) / 2) * glm::dot(p, forward);
    return glm::dvec2(width, height) / 2.0 + glm::dvec2(glm::dot(p, right), glm::dot(p, up)) / half * height / 2.0;
}

class MotionTest : public PictureTest {
  protected:
    Scene scene;

    /// A scene of a wall at z = -2, node 0, and a square |x|, |y| <= 1 at z = 0, node 1.
    MotionTest() {
        scene.name = "test";
        scene.materials = {unlit({1, 1, 1})};
        add(parallelogram({-20, -20, -2}, {40, 0, 0}, {0, 40, 0}));
        add(texture_square());
    }
    int add(Primitive shape) {
        Node node;
        node.mesh = int(scene.meshes.size());
        node.fixed = false;
        scene.meshes.push_back({"mesh", {std::move(shape)}, {}});
        scene.nodes.push_back(node);
        return int(scene.nodes.size()) - 1;
    }
    void animate(int node, Path path, std::vector<float> times, std::vector<float> values,
                 Interpolation interpolation = Interpolation::linear) {
        if (scene.animations.empty()) scene.animations.push_back({"move", 1, {}});
        const auto width = uint32_t(values.size() / times.size());
        scene.animations[0].channels.push_back({node, path, interpolation, width, std::move(times), std::move(values)});
    }
    Picture look(const RenderSettings& settings, double time = 0.75, double before = 0.5) {
        return render_at(scene, time, before, settings);
    }
    static RenderSettings seen(const Camera& camera) {
        RenderSettings settings = settings_for(camera, 64);
        settings.width = 80;
        settings.camera_before = camera;
        return settings;
    }
    /// Compares each pixel that sees `instance`, whose points lie at `z`. `earlier`: where a point was.
    void expect_motion(const Picture& picture, const RenderSettings& s, int instance, double z,
                       const std::function<glm::dvec3(const glm::dvec3&)>& earlier) {
        Tally result;
        for (uint32_t y = 0; y < s.height; y++)
            for (uint32_t x = 0; x < s.width; x++) {
                const size_t i = size_t(y) * s.width + x;
                if (picture.aovs.instance[i] != float(instance)) continue;
                const glm::dvec3 now = view_ray(s.camera, s.width, s.height, x + 0.5, y + 0.5).at_plane(2, z);
                const glm::dvec2 want = place(s.camera_before, s.width, s.height, earlier(now)) -
                                        place(s.camera, s.width, s.height, now),
                                 got = picture.aovs.motion[i];
                result.add(glm::length(got - want) < 2e-3, [&] {
                    return fmt::format("pixel {},{}: {} {}, expected {} {}", x, y, got.x, got.y, want.x, want.y);
                });
            }
        result.expect(0, 300);
    }
    static void expect_still(const Picture& picture, int instance) {
        for (size_t i = 0; i < picture.aovs.motion.size(); i++)
            if (picture.aovs.instance[i] == float(instance)) {
                ASSERT_EQ(picture.aovs.motion[i], glm::vec2(0)) << i;
            }
    }
    const Camera flat = orthographic({0, 0, 3}, {0, 0, 0}, 4), deep = perspective({0.3f, 0.4f, 4}, {0, 0.1f, 0}, 50);
};

TEST_F(MotionTest, OfANodeThatMoves) {
    animate(1, Path::translation, {0, 1}, {-0.5f, 0, 0, 0.5f, 0.25f, 0});
    const RenderSettings settings = seen(flat);
    const Picture picture = look(settings);
    // A quarter of a second, and 16 pixels a unit: it has come from the left and from below.
    const size_t middle = 32 * 80 + 44;
    EXPECT_NEAR(picture.aovs.motion[middle].x, -4, 1e-4);
    EXPECT_NEAR(picture.aovs.motion[middle].y, -1, 1e-4);
    for (const Camera& camera : {flat, deep}) {
        const RenderSettings s = seen(camera);
        const Picture p = look(s);
        expect_motion(p, s, 1, 0, [](const glm::dvec3& q) { return q - glm::dvec3(0.25, 0.0625, 0); });
        expect_still(p, 0);
    }
}

TEST_F(MotionTest, OfANodeThatComesNearerAndTurns) {
    const float s = std::sqrt(0.5f);
    animate(1, Path::translation, {0, 1}, {0, 0, -1, 0, 0, 1});
    animate(1, Path::rotation, {0, 1}, {0, 0, 0, 1, 0, 0, s, s});  // a quarter around z
    const RenderSettings settings = seen(deep);
    expect_motion(look(settings), settings, 1, 0.5, [](const glm::dvec3& q) {
        const double c = std::cos(kPi / 8), t = std::sin(kPi / 8);
        return glm::dvec3(c * q.x + t * q.y, -t * q.x + c * q.y, 0);
    });
}

TEST_F(MotionTest, OfWhatMorphs) {
    Primitive& square = scene.meshes[1].primitives[0];
    square.targets.resize(1);
    for (const glm::vec3& p : square.positions) square.targets[0].positions.push_back({p.x, 0.5f * p.y, 0});
    animate(1, Path::weights, {0, 1}, {-0.5f, 0.5f});
    for (const Camera& camera : {flat, deep}) {
        const RenderSettings settings = seen(camera);
        const Picture picture = look(settings);  // weights 0 and 0.25
        expect_motion(picture, settings, 1, 0,
                      [](const glm::dvec3& q) { return glm::dvec3(q.x / 1.25, q.y / 1.125, 0); });
        expect_still(picture, 0);
    }
}

TEST_F(MotionTest, OfASkin) {
    // One joint turns all of it, another stretches what hangs on both.
    Primitive& square = scene.meshes[1].primitives[0];
    JointWeights both;
    both.joints = {0, 1};
    both.weights = {0.5f, 0.5f};
    square.joints.assign(square.positions.size(), both);
    const int first = int(scene.nodes.size());
    for (int i = 0; i < 2; i++) {
        Node joint;
        joint.fixed = false;
        scene.nodes.push_back(joint);
    }
    scene.skins.push_back({"skin", {first, first + 1}, {glm::mat4(1), glm::mat4(1)}});
    scene.nodes[1].skin = 0;
    animate(first, Path::translation, {0, 1}, {0, 0, 0, 1, 0, 0});
    animate(first + 1, Path::translation, {0, 1}, {0, 0, 0, 0, 0.5f, 0});
    const RenderSettings settings = seen(deep);
    const Picture picture = look(settings);
    expect_motion(picture, settings, 1, 0, [](const glm::dvec3& q) { return q - glm::dvec3(0.125, 0.0625, 0); });
    expect_still(picture, 0);
}

TEST_F(MotionTest, OfWhatWasTurnedOver) {
    // Its mirror image a moment before: its triangles ran the other way round.
    animate(1, Path::scale, {0, 0.6f, 1}, {-1, 1, 1, 1.25f, 1, 1, 1, 1, 1}, Interpolation::step);
    const RenderSettings settings = seen(flat);
    expect_motion(look(settings), settings, 1, 0, [](const glm::dvec3& q) { return glm::dvec3(-q.x / 1.25, q.y, 0); });
}

TEST_F(MotionTest, OfTheCamera) {
    const auto stays = [](const glm::dvec3& q) { return q; };
    for (const Camera& now : {flat, deep}) {
        Camera beside = now, turned_up = now, wider = now;
        beside.eye += glm::dvec3(0.3, -0.2, 0.4);
        beside.look += glm::dvec3(0.3, -0.2, 0.4);
        turned_up.look += glm::dvec3(0.2, 0.5, 0);
        turned_up.up = {0.2f, 1, 0};
        wider.vertical_fov *= 1.2f;
        wider.orthographic_height *= 1.2f;
        for (const Camera& before : {beside, turned_up, wider, turned(now, -1 / 90.0)}) {
            RenderSettings settings = seen(now);
            settings.camera_before = before;
            const Picture picture = look(settings);
            expect_motion(picture, settings, 1, 0, stays);
            expect_motion(picture, settings, 0, -2, stays);
        }
        const Picture picture = look(seen(now));
        expect_still(picture, 0);
        expect_still(picture, 1);
    }
}

TEST_F(MotionTest, OfTheCameraAndANodeAtOnce) {
    animate(1, Path::translation, {0, 1}, {-0.5f, 0, 0, 0.5f, 0.25f, 0});
    RenderSettings settings = seen(deep);
    settings.camera_before.eye.x -= 0.25;
    settings.camera_before.look.x -= 0.25;
    expect_motion(look(settings), settings, 1, 0, [](const glm::dvec3& q) { return q - glm::dvec3(0.25, 0.0625, 0); });
}

TEST_F(MotionTest, WhatWasBehindTheCameraHasNone) {
    RenderSettings settings = seen(deep);
    settings.camera_before = perspective({0.3f, 0.4f, -1}, {0, 0.1f, -5}, 50);
    const Picture picture = look(settings);
    expect_still(picture, 1);
    expect_motion(picture, settings, 0, -2, [](const glm::dvec3& q) { return q; });
    // An orthographic camera has a place for all that is to its sides.
    settings = seen(flat);
    settings.camera_before = orthographic({0.5f, 0, -1}, {0.5f, 0, -5}, 4);
    expect_motion(look(settings), settings, 1, 0, [](const glm::dvec3& q) { return q; });
}

TEST_F(MotionTest, OnlyWhereItIsAskedForAndThereIsSomething) {
    animate(0, Path::translation, {0, 1}, {0, 0, 0, 1, 0, 0});
    scene.meshes[0].primitives[0] = parallelogram({-1, -1, -1}, {2, 0, 0}, {0, 2, 0});
    RenderSettings settings = seen(flat);
    const Picture picture = look(settings);
    EXPECT_EQ(picture.aovs.instance[0], -1);
    EXPECT_EQ(picture.aovs.motion[0], glm::vec2(0));
    EXPECT_NE(picture.aovs.motion[32 * 80 + 65], glm::vec2(0)) << "the wall moves";
    settings.spp = 3;
    EXPECT_EQ(look(settings).aovs.motion, picture.aovs.motion) << "at the pixels' centres";
}

TEST_F(MotionTest, InstancesKeepTheirNumbers) {
    // Nodes without triangles have none; three show one mesh, which has a body of its own where it has many triangles.
    for (const uint32_t rings : {2u, 24u}) {
        scene = {};
        scene.name = "test";
        scene.materials = {unlit({1, 1, 1})};
        scene.nodes.emplace_back();
        const int first = add(sphere({0, 0, 0}, 0.4f, rings));
        scene.nodes.emplace_back();
        for (int i = 0; i < 2; i++) {
            scene.nodes.push_back(scene.nodes[size_t(first)]);
        }
        const int last = int(scene.nodes.size()) - 1;
        add(parallelogram({-3, -1, -1}, {6, 0, 0}, {0, 0.2f, 0}));
        for (int i = 0; i < 2; i++) {
            scene.nodes[size_t(last - i)].rest.translation = {i == 0 ? 1.2 : -1.2, 0, 0};
            scene.nodes[size_t(last - i)].local = scene.nodes[size_t(last - i)].rest.matrix();
        }
        // The first leaves the picture upwards, the second comes to where the third was.
        animate(first, Path::translation, {0, 1}, {0, 0, 0, 0, 9, 0});
        animate(last - 1, Path::translation, {0, 1}, {-1.2f, 0, 0, 1.2f, 0, 0});
        animate(last, Path::translation, {0, 1}, {1.2f, 0, 0, -1.2f, 0, 0});
        const auto at = [&](double time, double x, double y) {
            const Picture picture = look(seen(flat), time, time);
            return picture.aovs.instance[size_t((2 - y) * 16) * 80 + size_t((x + 2.5) * 16)];
        };
        EXPECT_EQ(at(0, 0, 0), 0);
        EXPECT_EQ(at(0, -1.2, 0), 1);
        EXPECT_EQ(at(0, 1.2, 0), 2);
        EXPECT_EQ(at(1, 0, 0), -1);
        EXPECT_EQ(at(1, 1.2, 0), 1);
        EXPECT_EQ(at(1, -1.2, 0), 2);
        for (const double time : {0.0, 0.5, 1.0}) EXPECT_EQ(at(time, 0.1, -0.9), 3);
    }
}

}  // namespace
}  // namespace peelray
