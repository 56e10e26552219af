// A triangle as an LDI sees it: normal, axis, projection, coverage, depth range and packing, against double precision.
#include "exact_clip.h"
#include "ldc/cubes.h"
#include "probe_fixture.h"
#include "sample_plane.h"

namespace peelray {
namespace {

using glm::dvec2;
using glm::dvec3;
using glm::ivec2;
using glm::uvec2;
using glm::vec2;
using glm::vec3;

dvec3 permuted(const dvec3& p, uint32_t axis) {
    return {p[(axis + 1) % 3], p[(axis + 2) % 3], p[axis]};
}

// --- ldcNormal, ldcAxis, ldcCaptured, ldcProject, ldcBounds ---

struct ProjectIn {
    CubeGrid grid;
    vec3 a, b, c;
    uint32_t axis, planar;
};
struct ProjectOut {
    vec3 normal;
    uint32_t axis, captured, inside;
    vec3 a, b, c;
    vec2 slope;
    ivec2 lo, hi;
};

class LdcProjectProbe : public ProbeTest {
  protected:
    /// Triangles of all sizes inside the grid, a third of them needles.
    std::vector<ProjectIn> inputs() {
        std::vector<ProjectIn> list;
        for (int i = 0; i < 30000; i++) {
            ProjectIn x{};
            x.grid.voxel = float(std::exp2(uniform(-8, 4)));
            x.grid.inv_voxel = 1 / x.grid.voxel;
            for (int k = 0; k < 3; k++) x.grid.dims[k] = 16 * (1 + bits() % 32);
            x.grid.origin = point(-100, 100) * x.grid.voxel;
            const dvec3 dims(x.grid.dims);
            const auto place = [&](const dvec3& v) {
                return vec3(dvec3(x.grid.origin) + glm::clamp(v, dvec3(0), dims) * double(x.grid.voxel));
            };
            const dvec3 centre(uniform(0, dims.x), uniform(0, dims.y), uniform(0, dims.z));
            const double size = std::exp2(uniform(-3, 8));
            const dvec3 p = centre + unit() * size, q = centre + unit() * size;
            const double along = uniform(-0.5, 1.5);
            x.a = place(p);
            x.b = place(q);
            x.c = place(i % 3 == 0 ? p + (q - p) * along + unit() * 1e-3 : centre);
            x.planar = i & 1;
            x.axis = uint32_t(i / 2 % 3);
            list.push_back(x);
        }
        return list;
    }
};

TEST_F(LdcProjectProbe, NormalsOfNeedlesKeepTheirDirection) {
    const auto in = inputs();
    const auto out = probe<ProjectOut>("probe_ldc_project", in);
    for (size_t i = 0; i < in.size(); i++) {
        // Edges as the shader has them; their cross product in double has no cancellation worth the name.
        const dvec3 e(vec3((in[i].b - in[i].a) * in[i].grid.inv_voxel)),
            f(vec3((in[i].c - in[i].a) * in[i].grid.inv_voxel));
        const dvec3 exact = glm::cross(e, f);
        for (int k = 0; k < 3; k++)
            ASSERT_NEAR(out[i].normal[k], exact[k], 3e-7 * std::abs(exact[k]) + 1e-30) << i << " component " << k;
        const dvec3 m = glm::abs(dvec3(out[i].normal));
        const double largest = std::max({m.x, m.y, m.z});
        if (largest == 0) continue;  // without area: the builder drops it
        ASSERT_LT(out[i].axis, 3u);
        ASSERT_EQ(m[int(out[i].axis)], largest);
        for (uint32_t k = 0; k < out[i].axis; k++) ASSERT_LT(m[int(k)], largest) << "the first of equals";
        const double share = m[int(in[i].axis)] / largest;
        if (std::abs(share - 0.8) < 1e-6) continue;
        ASSERT_EQ(out[i].captured, uint32_t(in[i].axis == out[i].axis || (in[i].planar && share > 0.8)));
    }
}

TEST_F(LdcProjectProbe, EqualComponentsGoToTheFirstAxisAndTheBand) {
    std::vector<ProjectIn> in;
    const vec3 corner[3] = {{8, 0, 0}, {0, 8, 0}, {0, 0, 8}};  // normal (1, 1, 1)
    for (uint32_t axis = 0; axis < 3; axis++)
        for (uint32_t planar = 0; planar < 2; planar++)
            in.push_back({{vec3(0), 1, glm::uvec3(16), 1}, corner[0], corner[1], corner[2], axis, planar});
    const auto out = probe<ProjectOut>("probe_ldc_project", in);
    for (size_t i = 0; i < in.size(); i++) {
        EXPECT_EQ(out[i].axis, 0u);
        EXPECT_EQ(out[i].captured, uint32_t(in[i].planar || in[i].axis == 0));
    }
}

TEST_F(LdcProjectProbe, CornersAreInVoxelsAndCounterClockwise) {
    const auto in = inputs();
    const auto out = probe<ProjectOut>("probe_ldc_project", in);
    for (size_t i = 0; i < in.size(); i++) {
        const auto& g = in[i].grid;
        if (in[i].axis != out[i].axis) continue;
        std::array<dvec3, 3> want;
        const vec3 corners[3] = {in[i].a, in[i].b, in[i].c};
        for (size_t k = 0; k < 3; k++)
            want[k] = permuted((dvec3(corners[k]) - dvec3(g.origin)) / double(g.voxel), in[i].axis);
        if (permuted(out[i].normal, in[i].axis).z < 0) std::swap(want[1], want[2]);
        const vec3 got[3] = {out[i].a, out[i].b, out[i].c};
        for (size_t k = 0; k < 3; k++)
            for (int j = 0; j < 3; j++) ASSERT_NEAR(got[k][j], want[k][j], 4e-7 * (1 + want[k][j])) << i;
        const dvec2 e = dvec2(want[1]) - dvec2(want[0]), f = dvec2(want[2]) - dvec2(want[0]);
        ASSERT_GE(e.x * f.y - e.y * f.x, -1e-4) << i;
        // Every pixel that a corner lies in belongs to the bounds, and they are not wider than the slack.
        dvec2 low(1e9), high(-1e9);
        for (const auto& p : want) low = glm::min(low, dvec2(p)), high = glm::max(high, dvec2(p));
        const dvec2 dims(permuted(dvec3(g.dims), in[i].axis));
        ASSERT_TRUE(out[i].inside);
        for (int j = 0; j < 2; j++) {
            ASSERT_LE(out[i].lo[j], std::floor(low[j]));
            ASSERT_GE(out[i].lo[j], std::max(0.0, std::floor(low[j] - 2e-3)));
            ASSERT_GE(out[i].hi[j], std::min(dims[j] - 1, std::floor(high[j])));
            ASSERT_LE(out[i].hi[j], std::min(dims[j] - 1, std::floor(high[j] + 2e-3)));
        }
    }
}

TEST_F(LdcProjectProbe, SlopesAreThoseOfThePlane) {
    const auto in = inputs();
    const auto out = probe<ProjectOut>("probe_ldc_project", in);
    double steepest = 0;
    for (size_t i = 0; i < in.size(); i++) {
        if (!out[i].captured || out[i].normal == vec3(0)) continue;
        const dvec3 n = permuted(out[i].normal, in[i].axis);
        const dvec2 slope(-n.x / n.z, -n.y / n.z);
        steepest = std::max({steepest, std::abs(slope.x), std::abs(slope.y)});
        // The band's slopes (planar only) reach 1.25; a clamped plane would miss its own triangle.
        ASSERT_NEAR(out[i].slope.x, slope.x, 1e-6) << i;
        ASSERT_NEAR(out[i].slope.y, slope.y, 1e-6) << i;
    }
    EXPECT_GT(steepest, 1.2);
}

// --- ldcEdges, ldcCovers, ldcDepthRange, ldcPackSample ---

struct PixelIn {
    vec3 a, b, c;
    vec2 slope;
    ivec2 pixel;
    uint32_t voxel_w, planar;
};
struct PixelOut {
    vec3 edges;
    uint32_t covers;
    ivec2 depth;
    glm::uvec4 packed;
    uint32_t touches;
};

class LdcPixelProbe : public ProbeTest {
  protected:
    /// Triangles (big, tiny, needles) of slopes in [-1, 1] ([-1.25, 1.25] with the overlap band) and pixels in or near
    /// their bounding box.
    std::vector<PixelIn> inputs(bool planar) {
        std::vector<PixelIn> list;
        while (list.size() < 60000) {
            const double size = std::exp2(uniform(-5, 6)), n = 128;
            const dvec2 centre(uniform(0, n), uniform(0, n));
            dvec2 p[3];
            for (auto& q : p) q = glm::clamp(centre + size * dvec2(uniform(-1, 1), uniform(-1, 1)), dvec2(0), dvec2(n));
            const size_t kind = list.size() % 4;
            if (kind == 1)
                p[2] = p[0] + (p[1] - p[0]) * uniform(-0.2, 1.2) + dvec2(uniform(-1, 1), uniform(-1, 1)) * 1e-3;
            if (kind == 2) p[1].x = p[0].x;                                   // an edge along an axis
            if (kind == 3) p[0] = glm::floor(p[0]), p[1] = glm::floor(p[1]);  // corners on pixel corners
            PixelIn x{};
            const double area = (p[1].x - p[0].x) * (p[2].y - p[0].y) - (p[1].y - p[0].y) * (p[2].x - p[0].x);
            if (std::abs(area) < 1e-6) continue;
            if (area < 0) std::swap(p[1], p[2]);
            x.slope = vec2(uniform(-1, 1), uniform(-1, 1)) * (planar ? 1.25f : 1.0f);
            const double w0 = uniform(0, n);
            const auto lift = [&](dvec2 q) { return vec3(q.x, q.y, w0 + glm::dot(dvec2(x.slope), q - centre)); };
            x.a = lift(p[0]), x.b = lift(p[1]), x.c = lift(p[2]);
            // A point of the triangle, or near it.
            const double s = uniform(-0.1, 1.1), t = uniform(-0.1, 1.1);
            const dvec2 near =
                p[0] + (p[1] - p[0]) * s + (p[2] - p[0]) * (t * (1 - s)) + dvec2(uniform(-1, 1), uniform(-1, 1));
            x.pixel = ivec2(glm::clamp(glm::floor(near), dvec2(0), dvec2(n - 1)));
            const double w = w0 + glm::dot(dvec2(x.slope), dvec2(x.pixel) + 0.5 - centre);
            x.voxel_w = uint32_t(std::clamp(std::floor(w + uniform(-0.5, 0.5)), 0.0, n - 1));
            x.planar = planar;
            list.push_back(x);
        }
        return list;
    }
    static std::array<dvec3, 3> corners(const PixelIn& x) { return {dvec3(x.a), dvec3(x.b), dvec3(x.c)}; }
    static Polygon in_pixel(const PixelIn& x) {
        const auto t = corners(x);
        const dvec3 lo(x.pixel.x, x.pixel.y, 0);
        return clip_box(Polygon(t.begin(), t.end()), lo, lo + 1.0, 2);
    }
    /// Depth of the triangle's plane over a point.
    static double plane(const PixelIn& x, dvec2 p) { return double(x.a.z) + glm::dot(dvec2(x.slope), p - dvec2(x.a)); }
};

TEST_F(LdcPixelProbe, ConservativeCoverageIsExactClippingAndAThinSlack) {
    const auto in = inputs(false);
    const auto out = probe<PixelOut>("probe_ldc_pixel", in);
    size_t touched = 0, free = 0;
    for (size_t i = 0; i < in.size(); i++) {
        const auto t = corners(in[i]);
        const dvec2 centre = dvec2(in[i].pixel) + 0.5;
        if (!in_pixel(in[i]).empty()) {
            touched++;
            ASSERT_TRUE(out[i].covers) << i;
        }
        if (edge_distance(t, centre, 0.5) < -2e-3) {
            free++;
            ASSERT_FALSE(out[i].covers) << i;
        }
    }
    EXPECT_GT(touched, 15000u);
    EXPECT_GT(free, 5000u);
}

TEST_F(LdcPixelProbe, CentreCoverageIsThePixelsCentre) {
    const auto in = inputs(true);
    const auto out = probe<PixelOut>("probe_ldc_pixel", in);
    size_t inside = 0, outside = 0;
    for (size_t i = 0; i < in.size(); i++) {
        const auto t = corners(in[i]);
        const dvec2 centre = dvec2(in[i].pixel) + 0.5;
        const double distance = edge_distance(t, centre, 0);
        inside += distance >= 0;
        outside += distance < -2e-3;
        ASSERT_TRUE(out[i].covers || distance < 0) << i;
        ASSERT_TRUE(!out[i].covers || distance >= -2e-3) << i;
        for (int k = 0; k < 3; k++) {
            const dvec2 a(t[size_t(k)]), e = dvec2(t[size_t(k + 1) % 3]) - a, p = centre - a;
            ASSERT_NEAR(out[i].edges[k], e.x * p.y - e.y * p.x, 1e-6 * (1 + glm::length(e) * glm::length(p)));
        }
    }
    EXPECT_GT(inside, 9000u);
    EXPECT_GT(outside, 9000u);
}

TEST_F(LdcPixelProbe, DepthRangesHoldTheTriangleAndLittleMore) {
    for (const bool planar : {false, true}) {
        const auto in = inputs(planar);
        const auto out = probe<PixelOut>("probe_ldc_pixel", in);
        for (size_t i = 0; i < in.size(); i++) {
            const Polygon inside = in_pixel(in[i]);
            if (inside.empty()) continue;
            const dvec2 centre = dvec2(in[i].pixel) + 0.5;
            const double half = planar ? 0.7 : 0.5;
            double low = 1e9, high = -1e9;
            for (int corner = 0; corner < 4; corner++) {
                const double w = plane(in[i], centre + half * dvec2(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1));
                low = std::min(low, w), high = std::max(high, w);
            }
            if (!planar) {
                // The part of the triangle in the pixel is in; corners of needles do not lie in their own rounded
                // plane.
                for (const auto& p : inside) {
                    ASSERT_LE(out[i].depth.x, std::floor(p.z)) << i;
                    ASSERT_GE(out[i].depth.y, std::floor(p.z)) << i;
                }
                const auto t = corners(in[i]);
                low = std::max(low, std::min({t[0].z, t[1].z, t[2].z}));
                high = std::min(high, std::max({t[0].z, t[1].z, t[2].z}));
            } else {
                ASSERT_LE(out[i].depth.x, std::floor(low)) << i;
                ASSERT_GE(out[i].depth.y, std::floor(high)) << i;
            }
            ASSERT_GE(out[i].depth.x, std::floor(low - 3e-3)) << i;
            ASSERT_LE(out[i].depth.y, std::floor(high + 3e-3)) << i;
        }
    }
}

TEST_F(LdcPixelProbe, VoxelsTouchedAreThoseOfExactClippingAndAThinSlack) {
    const auto in = inputs(false);
    const auto out = probe<PixelOut>("probe_ldc_pixel", in);
    size_t touched = 0, free = 0;
    for (size_t i = 0; i < in.size(); i++) {
        const auto t = corners(in[i]);
        const dvec3 lo(in[i].pixel.x, in[i].pixel.y, in[i].voxel_w), centre = lo + 0.5;
        if (!clip_box(Polygon(t.begin(), t.end()), lo, lo + 1.0, 3).empty()) {
            touched++;
            ASSERT_TRUE(out[i].touches) << i;
        }
        if (side_distance(t, centre, 0.5) < -4e-3) {
            free++;
            ASSERT_FALSE(out[i].touches) << i;
        }
    }
    EXPECT_GT(touched, 10000u);
    EXPECT_GT(free, 5000u);
}

TEST_F(LdcPixelProbe, PackedSamplesDecodeWithinTheirBounds) {
    for (const bool planar : {false, true}) {
        const auto in = inputs(planar);
        const auto out = probe<PixelOut>("probe_ldc_pixel", in);
        double worst_w = 0, worst_slope = 0;
        size_t clamped = 0;
        for (size_t i = 0; i < in.size(); i++) {
            const glm::uvec4 data = out[i].packed;
            const test::SamplePlane stored = planar ? test::plane_of_sample(uvec2(data)) : test::plane_of_patch(data);
            const double true_w = plane(in[i], dvec2(in[i].pixel) + 0.5) - in[i].voxel_w - 0.5;
            if (!planar || std::abs(true_w) < 2.5) {
                // Corners are floats up to 128: their rounding is not the packing's.
                worst_w = std::max(worst_w, std::abs(stored.w - true_w) - 1e-7 * 256);
            } else {
                clamped++;
                ASSERT_EQ(stored.w, true_w < 0 ? -2.5f : 2.5f);
            }
            ASSERT_EQ(stored.normal.z, 1);
            ASSERT_TRUE(stored.normal.x != 1 && stored.normal.y != 1) << "that would be the axis";
            worst_slope = std::max({worst_slope, std::abs(double(stored.normal.x) + in[i].slope.x),
                                    std::abs(double(stored.normal.y) + in[i].slope.y)});
            ASSERT_TRUE(planar ? data.y >> 31 : data.z & 1) << "the last of its list";
            ASSERT_TRUE(planar || data.w == (7u << 2 | 2));
        }
        EXPECT_LE(worst_w, planar ? 7.7e-5 : 2e-5);
        EXPECT_LE(worst_slope, 7.4e-4) << "half floats up to 1.25, of which only the axis's may be 1";
        EXPECT_LT(clamped, in.size() / 20);
    }
}

TEST_F(LdcPixelProbe, CoverageBitsHoldEveryPointOfTheTriangle) {
    const auto in = inputs(false);
    const auto out = probe<PixelOut>("probe_ldc_pixel", in);
    size_t must = 0, must_not = 0;
    for (size_t i = 0; i < in.size(); i++) {
        const auto t = corners(in[i]);
        const Polygon inside = in_pixel(in[i]);
        if (inside.empty()) continue;
        for (int cell = 0; cell < 16; cell++) {
            const bool bit = out[i].packed.y >> (16 + cell) & 1;
            const dvec3 lo = dvec3(in[i].pixel, 0) + 0.25 * dvec3(cell % 4, cell / 4, 0);
            const bool touched = !clip_box(inside, lo, lo + 0.25, 2).empty();
            // Not farther than the declared 0.03 pixels along both axes (times √2 across a diagonal edge).
            const bool far = edge_distance(t, dvec2(lo) + 0.125, 0.125) < -0.03 * 1.5;
            must += touched;
            must_not += far;
            ASSERT_TRUE(bit || !touched) << i << " cell " << cell;
            ASSERT_TRUE(!bit || !far) << i << " cell " << cell;
        }
    }
    EXPECT_GT(must, 50000u);
    EXPECT_GT(must_not, 50000u);
}

}  // namespace
}  // namespace peelray
