// The figure of builtin:walker: a sound skin, a gait that walks.

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "builtin/walker.h"
#include "loaders/load.h"
#include "loaders/scene_files.h"
#include "motion/animation.h"

namespace peelray::testing {
namespace {

using glm::vec3;

const Mesh& figure(const Scene& scene) {
    for (const Node& node : scene.nodes)
        if (node.skin >= 0) return scene.meshes.at(size_t(node.mesh));
    throw std::runtime_error("no figure");
}

/// The figure's vertices now, in the order of figure()'s primitives, and its triangles.
struct Figure {
    std::vector<vec3> positions, normals;
    std::vector<glm::uvec3> triangles;
};

Figure figure_at(Scene scene, const Moment& moment) {
    for (Node& node : scene.nodes)
        if (node.skin < 0) node.mesh = -1;
    const Geometry g = flatten(scene, moment);
    return {g.positions, g.normals, g.triangles};
}

Figure figure_at(const Scene& scene, const char* animation, double time) {
    return figure_at(scene, moment_of(scene, animation, time));
}

const Scene& walker() {
    static const Scene scene = load_scene("builtin:walker");
    return scene;
}

/// The joint that pulls most at each vertex, in the same order.
std::vector<Joint> leading_joints(const Scene& scene) {
    std::vector<Joint> out;
    for (const Primitive& p : figure(scene).primitives)
        for (const JointWeights& w : p.joints)
            out.push_back(
                Joint(w.joints[size_t(std::max_element(w.weights.begin(), w.weights.end()) - w.weights.begin())]));
    return out;
}

double stride_of(const Scene& scene) {
    return scene.animations.at(0).duration / 8;
}

TEST(Walker, SkinIsClosedAndConsistentlyWound) {
    // Over all primitives: garments meet in the same points.
    using Point = std::tuple<float, float, float>;
    std::map<std::pair<Point, Point>, int> edges;
    double volume = 0;
    size_t triangles = 0;
    for (const Primitive& p : figure(walker()).primitives)
        for (const glm::uvec3& t : p.triangles) {
            const auto key = [&](int k) {
                const vec3& at = p.positions[t[k]];
                return Point{at.x, at.y, at.z};
            };
            for (int k = 0; k < 3; ++k) ++edges[{key(k), key((k + 1) % 3)}];
            volume += glm::dot(p.positions[t.x], glm::cross(p.positions[t.y], p.positions[t.z])) / 6;
            ++triangles;
        }
    size_t open = 0;
    for (const auto& [edge, count] : edges) open += count != 1 || edges.count({edge.second, edge.first}) == 0;
    EXPECT_EQ(open, 0u);
    EXPECT_GT(volume, 0.04);  // cubic metres
    EXPECT_LT(volume, 0.12);
    EXPECT_GE(triangles, 10000u);
    EXPECT_LE(triangles, 22000u);
}

TEST(Walker, WeightsAreSound) {
    const Skin& skin = walker().skins.at(0);
    ASSERT_EQ(skin.joints.size(), joint_count);
    ASSERT_EQ(skin.inverse_bind.size(), joint_count);
    std::vector<size_t> leads(joint_count);
    for (const Primitive& p : figure(walker()).primitives) {
        ASSERT_EQ(p.joints.size(), p.positions.size());
        ASSERT_EQ(p.normals.size(), p.positions.size());
        for (const JointWeights& w : p.joints) {
            float sum = 0;
            int used = 0;
            for (size_t k = 0; k < w.weights.size(); ++k) {
                ASSERT_GE(w.weights[k], 0);
                ASSERT_LT(w.joints[k], joint_count);
                sum += w.weights[k];
                used += w.weights[k] > 0;
            }
            ASSERT_NEAR(sum, 1, 1e-5);
            ASSERT_LE(used, 4);
        }
    }
    for (const Joint joint : leading_joints(walker())) ++leads[size_t(joint)];
    EXPECT_EQ(leads[size_t(Joint::root)], 0u);
    for (size_t joint = 1; joint < joint_count; ++joint) EXPECT_GT(leads[joint], 20u) << walker_joints()[joint].name;
}

size_t normals_against_triangles(const Figure& m) {
    size_t against = 0;
    for (const glm::uvec3& t : m.triangles) {
        const vec3 face = glm::cross(m.positions[t.y] - m.positions[t.x], m.positions[t.z] - m.positions[t.x]);
        against += glm::dot(face, m.normals[t.x] + m.normals[t.y] + m.normals[t.z]) <= 0;
    }
    return against;
}

TEST(Walker, NormalsAreUnitAndAgreeWithTheTriangles) {
    Scene scene = walker();
    EXPECT_EQ(normals_against_triangles(figure_at(scene, at_rest(scene))), 0u);
    for (const char* name : {"walk", "wave"})
        for (double time = 0; time < 0.9; time += 0.1) {
            const Figure m = figure_at(scene, name, time);
            for (const vec3& n : m.normals) ASSERT_NEAR(glm::length(n), 1, 1e-4);
            // A few may fold over deep in a crease, where an arm meets the ribs.
            EXPECT_LE(normals_against_triangles(m), 8u) << name << " " << time;
        }
}

/// The largest change of speed of any vertex at a moment, m/s; before the start lies the end.
double largest_jerk(Scene& scene, const char* name, double time, double duration) {
    constexpr double step = 0.004;
    const Figure before = figure_at(scene, name, time > 0 ? time - step : duration - step),
                 now = figure_at(scene, name, time), after = figure_at(scene, name, time + step);
    double largest = 0;
    for (size_t i = 0; i < now.positions.size(); ++i) {
        const vec3 change = (after.positions[i] - now.positions[i]) - (now.positions[i] - before.positions[i]);
        largest = std::max(largest, double(glm::length(change)) / step);
    }
    return largest;
}

TEST(Walker, AnimationsLoop) {
    Scene scene = walker();
    ASSERT_EQ(scene.animations.size(), 2u);
    for (const char* name : {"walk", "wave"}) {
        const Animation& animation = scene.animations[name == std::string("wave")];
        EXPECT_EQ(animation.name, name);
        const double duration = animation.duration;
        EXPECT_GT(duration, 0.5);
        EXPECT_LT(duration, 10);
        const Figure start = figure_at(scene, name, 0), end = figure_at(scene, name, duration);
        for (size_t i = 0; i < start.positions.size(); ++i) {
            ASSERT_LT(glm::distance(start.positions[i], end.positions[i]), 1e-6f);
            ASSERT_LT(glm::distance(start.normals[i], end.normals[i]), 1e-5f);
        }
    }
    // Where it starts again nothing jerks: all strides are alike, the first one too; and a wave is smooth throughout.
    const double stride = stride_of(scene), walk = 8 * stride;
    EXPECT_LT(largest_jerk(scene, "walk", 0, walk), 1.05 * largest_jerk(scene, "walk", 3 * stride, walk) + 0.01);
    EXPECT_LT(largest_jerk(scene, "walk", 0, walk), 1);
    EXPECT_LT(largest_jerk(scene, "wave", 0, scene.animations[1].duration), 0.2);
}

TEST(Walker, WalksItsCircle) {
    Scene scene = walker();
    const double duration = scene.animations.at(0).duration;
    double turned = 0;
    vec3 last(0);
    for (int i = 0; i <= 40; ++i) {
        vec3 middle(0);
        const Figure m = figure_at(scene, "walk", duration * i / 40);
        for (const vec3& p : m.positions) middle += p / float(m.positions.size());
        middle.y = 0;
        EXPECT_NEAR(glm::length(middle), 1.2, 0.08);
        // About the y axis, z towards x.
        if (i > 0)
            turned += std::asin(glm::normalize(last).z * glm::normalize(middle).x -
                                glm::normalize(last).x * glm::normalize(middle).z);
        last = middle;
    }
    EXPECT_NEAR(turned, 2 * M_PI, 0.01);
}

TEST(Walker, FeetStandOnTheFloorAndHardlySlide) {
    Scene scene = walker();
    constexpr int samples = 96;
    Figure last;
    for (int i = 0; i <= samples; ++i) {
        SCOPED_TRACE(i);
        const Figure now = figure_at(scene, "walk", stride_of(scene) * i / samples);
        float lowest = 1;
        for (const vec3& p : now.positions) lowest = std::min(lowest, p.y);
        EXPECT_GT(lowest, -0.0005f);
        EXPECT_LT(lowest, 0.002f);  // one foot always stands
        std::vector<float> ways;
        for (size_t k = 0; k < last.positions.size(); ++k)
            if (now.positions[k].y < 0.003f && last.positions[k].y < 0.003f)
                ways.push_back(glm::length(
                    glm::vec2(now.positions[k].x - last.positions[k].x, now.positions[k].z - last.positions[k].z)));
        last = now;
        if (i == 0) continue;
        // Of what touches the floor most stands still, to 4 cm/s while the figure goes at 1 m/s; heels and tips roll.
        ASSERT_GE(ways.size(), 20u);
        std::nth_element(ways.begin(), ways.begin() + long(ways.size() / 2), ways.end());
        EXPECT_LT(ways[ways.size() / 2], 0.0004f);
    }
}

TEST(Walker, AStandingFootStaysWhereItIs) {
    Scene scene = walker();
    const std::vector<Joint> joints = leading_joints(scene);
    for (const auto& [foot, from] : {std::pair{Joint::left_foot, 0.0}, std::pair{Joint::right_foot, 0.5}}) {
        const Figure start = figure_at(scene, "walk", (from + 0.10) * stride_of(scene)),
                     middle = figure_at(scene, "walk", (from + 0.213) * stride_of(scene)),
                     end = figure_at(scene, "walk", (from + 0.32) * stride_of(scene));
        size_t looked_at = 0;
        for (size_t i = 0; i < joints.size(); ++i) {
            if (joints[i] != foot || start.positions[i].y > 0.03f) continue;
            ++looked_at;
            ASSERT_LT(glm::distance(start.positions[i], middle.positions[i]), 0.0015f);
            ASSERT_LT(glm::distance(start.positions[i], end.positions[i]), 0.0015f);
        }
        EXPECT_GT(looked_at, 100u);
    }
}

TEST(Walker, SkinNeitherCollapsesNorTears) {
    Scene scene = walker();
    const Figure rest = figure_at(walker(), at_rest(walker()));
    const auto area = [](const Figure& m, size_t t) {
        const glm::uvec3& c = m.triangles[t];
        return glm::length(glm::cross(m.positions[c.y] - m.positions[c.x], m.positions[c.z] - m.positions[c.x]));
    };
    for (const char* name : {"walk", "wave"})
        for (int i = 0; i < 16; ++i) {
            SCOPED_TRACE(fmt::format("{} {}", name, i));
            const Figure now = figure_at(scene, name, 0.94 * i / 16);
            float least = 1, most = 1, all = 0, all_at_rest = 0;
            for (size_t t = 0; t < rest.triangles.size(); ++t) {
                const float before = area(rest, t), after = area(now, t);
                all += after;
                all_at_rest += before;
                if (before < 2e-5f) continue;  // a sliver along a seam says nothing
                least = std::min(least, after / before);
                most = std::max(most, after / before);
            }
            EXPECT_GT(least, 0.03f);
            EXPECT_LT(most, name == std::string("walk") ? 5.f : 10.f);
            EXPECT_NEAR(all / all_at_rest, 1, 0.03);
        }
}

TEST(Walker, LegsKeepClearOfEachOther) {
    Scene scene = walker();
    const std::vector<Joint> joints = leading_joints(scene);
    std::vector<size_t> left, right;
    for (size_t i = 0; i < joints.size(); ++i) {
        if (joints[i] >= Joint::left_shin && joints[i] <= Joint::left_toes) left.push_back(i);
        if (joints[i] >= Joint::right_shin && joints[i] <= Joint::right_toes) right.push_back(i);
    }
    for (int i = 0; i < 24; ++i) {
        const Figure m = figure_at(scene, "walk", stride_of(scene) * i / 24);
        float nearest = 1;
        for (const size_t a : left)
            for (const size_t b : right) {
                const vec3 way = m.positions[a] - m.positions[b];
                nearest = std::min(nearest, glm::dot(way, way));
            }
        EXPECT_GT(std::sqrt(nearest), 0.008f) << i;
    }
}

TEST(Walker, StandsAtRest) {
    const Figure rest = figure_at(walker(), at_rest(walker()));
    float lowest = 1, highest = 0, widest = 0;
    for (const vec3& p : rest.positions) lowest = std::min(lowest, p.y), highest = std::max(highest, p.y);
    vec3 middle(0);
    for (const vec3& p : rest.positions) middle += p / float(rest.positions.size());
    for (const vec3& p : rest.positions)
        widest = std::max(widest, glm::length(glm::vec2(p.x - middle.x, p.z - middle.z)));
    EXPECT_NEAR(lowest, 0, 0.0015);
    EXPECT_NEAR(highest, 1.75, 0.1);
    EXPECT_LT(widest, 0.4f);  // arms down, no T
}

}  // namespace
}  // namespace peelray::testing
