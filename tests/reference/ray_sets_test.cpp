// The rays of a frame as a benchmark sends them: which there are, in which order, and where they go.
#include "reference/ray_sets.h"
#include "motion/bounds.h"

#include <gtest/gtest.h>

#include <set>

#include "builtin/shapes.h"

namespace peelray {
namespace {

/// A ball of glass or anything else over a floor, seen from above.
class RaySetsTest : public testing::Test {
  protected:
    RaySetsTest() {
        SceneBuilder build("ball");
        const uint32_t grey = build.material(matte("grey", glm::vec3(0.5f)));
        build.add("ball", peelray::sphere({0, 1, 0}, 0.7f, 40), grey);
        build.add("floor", parallelogram({-3, 0, 3}, {6, 0, 0}, {0, 0, -6}), grey);
        build.camera({0, 3, 4}, {0, 0.7f, 0}, 60);
        scene_ = build.take();
        geometry_ = flatten(scene_);
        oracle_ = std::make_unique<Oracle>(geometry_);
        view_ = {scene_.cameras.front(), 44, 30, bounds(scene_, at_rest(scene_)), {}};
        view_.light.kind = Light::Kind::point;
        view_.light.position = {1, 4, 1};
    }

    RaySets make(const std::vector<RayKind>& kinds) const {
        return make_ray_sets(scene_, geometry_, *oracle_, view_, kinds);
    }
    std::vector<SurfaceRay> make(RayKind kind) const { return make(std::vector<RayKind>{kind})[size_t(kind)]; }
    OracleHit hit(const StartedRay& ray) const {
        return oracle_->closest({glm::dvec3(ray.origin), ray.tmin, glm::dvec3(ray.direction), ray.tmax});
    }
    size_t hits() const {
        size_t found = 0;
        for (const SurfaceRay& ray : make(RayKind::primary)) found += hit(leaving_ray(ray, 0)).hit();
        return found;
    }
    static bool on_floor(const SurfaceRay& ray) { return ray.point.y < 1e-4f; }

    Scene scene_;
    Geometry geometry_;
    std::unique_ptr<Oracle> oracle_;
    glm::vec3 eye() const { return glm::vec3(view_.camera.eye); }

    RaySetView view_{};
};

TEST_F(RaySetsTest, PrimaryRaysGoThroughAllPixelsInTiles) {
    const auto rays = make(RayKind::primary);
    ASSERT_EQ(rays.size(), 44u * 30);
    // The first eight go to the right along the first row, the ninth begins the second row at the left again.
    for (int i = 1; i < 8; i++) EXPECT_GT(rays[i].direction.x, rays[i - 1].direction.x);
    EXPECT_NEAR(rays[8].direction.x / rays[8].direction.z, rays[0].direction.x / rays[0].direction.z, 0.05);
    EXPECT_LT(rays[8].direction.y, rays[0].direction.y);
    EXPECT_GT(rays[64].direction.x, rays[7].direction.x);  // the second tile stands beside the first
    for (const SurfaceRay& ray : rays) {
        const StartedRay started = leaving_ray(ray, 0.5f);
        EXPECT_EQ(started.origin, eye());
        EXPECT_EQ(started.tmin, 0);
    }
}

TEST_F(RaySetsTest, OnlyWhatWasAskedFor) {
    const RaySets sets = make({RayKind::mirror, RayKind::diffuse});
    for (size_t i = 0; i < kRayKinds; i++)
        EXPECT_EQ(sets[i].empty(), RayKind(i) != RayKind::mirror && RayKind(i) != RayKind::diffuse) << i;
}

TEST_F(RaySetsTest, MirrorRaysLeaveTheFloorAsTheyCame) {
    const auto rays = make(RayKind::mirror);
    EXPECT_EQ(rays.size(), hits());
    size_t floor = 0;
    for (const SurfaceRay& ray : rays) {
        if (!on_floor(ray)) continue;
        floor++;
        const glm::vec3 came = glm::normalize(ray.point - eye());
        EXPECT_LT(glm::distance(ray.direction, came * glm::vec3(1, -1, 1)), 1e-5f);
        EXPECT_NEAR(ray.normal.y, 1, 1e-6);
    }
    EXPECT_GT(floor, 100u);
}

TEST_F(RaySetsTest, ShadowRaysEndAtTheLight) {
    for (const SurfaceRay& ray : make(RayKind::shadow))
        for (const float offset : {0.0f, 0.1f}) {
            const StartedRay started = leaving_ray(ray, offset);
            const glm::vec3 end = started.origin + started.tmax * started.direction;
            EXPECT_LT(glm::distance(end, view_.light.position), offset == 0 ? 2e-3f : 0.11f);
            EXPECT_GT(glm::dot(ray.direction, ray.normal), 0);
        }
}

TEST_F(RaySetsTest, AmbientAndDiffuseRaysSpreadByTheCosine) {
    const RaySets sets = make({RayKind::ambient, RayKind::diffuse});
    const auto &ambient = sets[size_t(RayKind::ambient)], &diffuse = sets[size_t(RayKind::diffuse)];
    EXPECT_EQ(diffuse.size(), hits());
    ASSERT_EQ(ambient.size(), 4 * diffuse.size());
    double mean = 0;
    size_t floor = 0;
    for (const SurfaceRay& ray : ambient) {
        EXPECT_NEAR(glm::length(ray.direction), 1, 1e-5);
        EXPECT_GT(glm::dot(ray.direction, ray.normal), 0);
        if (on_floor(ray)) mean += ray.direction.y, floor++;
    }
    EXPECT_NEAR(mean / double(floor), 2.0 / 3, 0.01);
    // Sample by sample, each from the same points as the others; no direction twice.
    std::set<std::tuple<float, float, float>> directions;
    for (size_t i = 0; i < diffuse.size(); i++) {
        if (on_floor(diffuse[i])) {
            EXPECT_EQ(ambient[i].point, diffuse[i].point);
        }
        EXPECT_EQ(ambient[i].point, ambient[i + diffuse.size()].point);
    }
    for (const SurfaceRay& ray : ambient) directions.insert({ray.direction.x, ray.direction.y, ray.direction.z});
    EXPECT_GT(directions.size(), ambient.size() * 99 / 100);
}

TEST_F(RaySetsTest, RefractedRaysFollowSnellThroughTheBall) {
    const auto rays = make(RayKind::refraction);
    const size_t first = hits();
    ASSERT_GT(rays.size(), first);
    size_t entering = 0, leaving = 0;
    for (size_t i = 0; i < rays.size(); i++) {
        const SurfaceRay& ray = rays[i];
        if (on_floor(ray)) continue;
        const glm::vec3 outwards = glm::normalize(ray.point - glm::vec3(0, 1, 0));
        const double sine = glm::length(glm::cross(glm::dvec3(outwards), glm::dvec3(ray.direction)));
        if (i < first) {
            entering++;
            const glm::dvec3 came = glm::normalize(ray.point - eye());
            EXPECT_NEAR(sine * 1.5, glm::length(glm::cross(glm::dvec3(outwards), came)), 5e-3);
            EXPECT_LT(glm::dot(ray.direction, outwards), 0.01f);
        } else if (glm::dot(ray.direction, outwards) > 0.1f) {
            leaving++;
        }
    }
    EXPECT_GT(entering, 50u);
    EXPECT_GT(leaving, entering / 2);
}

TEST_F(RaySetsTest, ALeavingRayCountsFromItsOffsetOnAndStaysOnItsLineIfItIsSteep) {
    const SurfaceRay steep{{1, 0, 0}, glm::normalize(glm::vec3(1, 1, 0)), INFINITY, {0, 1, 0}, 1e-6f, 7};
    StartedRay ray = leaving_ray(steep, 0.2f);
    EXPECT_LT(glm::distance(ray.origin, steep.point), 1e-5f);
    EXPECT_NEAR((ray.origin + ray.tmin * ray.direction).y, 0.2, 1e-5);
    ray = leaving_ray(steep, 0);
    EXPECT_EQ(ray.tmin, 0);
    EXPECT_FLOAT_EQ(ray.origin.y, 1e-6f);
    SurfaceRay flat = steep;
    flat.direction = glm::normalize(glm::vec3(1, -0.01f, 0));
    ray = leaving_ray(flat, 0.2f);
    EXPECT_NEAR(ray.tmin, 0.8, 1e-5);  // no farther along than four times the height
    EXPECT_NEAR((ray.origin + ray.tmin * ray.direction).y, -0.2, 1e-5);
}

}  // namespace
}  // namespace peelray
