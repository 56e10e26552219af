// Directions, faces and lookups of cube maps: no face is turned, no seam is seen.
#include "gpu/probe_fixture.h"

namespace peelray {
namespace {

struct CubeInput {
    glm::vec3 direction;
    uint32_t size;
};
struct CubeOutput {
    glm::vec3 looked_up;
    uint32_t face;
    glm::vec3 from_face;
};

class CubemapTest : public ProbeTest {
  protected:
    std::vector<CubeOutput> look_up(const std::vector<CubeInput>& in) { return probe<CubeOutput>("probe_cubemap", in); }
};

TEST_F(CubemapTest, DirectionsFindTheirFaceAndBack) {
    std::vector<CubeInput> in;
    for (int i = 0; i < 4000; i++) in.push_back({glm::vec3(unit()), 64});
    const auto out = look_up(in);
    for (size_t i = 0; i < in.size(); i++) {
        const glm::vec3 d = in[i].direction, back = glm::normalize(out[i].from_face);
        EXPECT_LT(glm::length(back - d), 1e-6f) << i;
        const int axis = int(out[i].face / 2);
        for (int k = 0; k < 3; k++) EXPECT_GE(std::abs(d[axis]), std::abs(d[k]));
        EXPECT_EQ(out[i].face % 2 == 1, d[axis] < 0);
    }
}

TEST_F(CubemapTest, LookupsInterpolateEverywhere) {
    for (uint32_t size : {8u, 17u, 512u}) {
        std::vector<CubeInput> in;
        for (int i = 0; i < 4000; i++) in.push_back({glm::vec3(unit()), size});
        const auto out = look_up(in);
        // The error of linear interpolation falls with the square of the texels' distance.
        const float tolerance = 1.2f / float((size - 1) * (size - 1)) + 2e-6f;
        for (size_t i = 0; i < in.size(); i++)
            EXPECT_LT(glm::length(out[i].looked_up - in[i].direction), tolerance) << size << " " << i;
    }
}

TEST_F(CubemapTest, NoSeamAtEdgesAndCorners) {
    std::vector<CubeInput> in;
    const float eps = 1e-6f;
    for (int i = 0; i < 500; i++) {
        const float along = float(uniform(-1, 1)), a = bits() % 2 ? 1.f : -1.f, b = bits() % 2 ? 1.f : -1.f;
        const int axis = int(bits() % 3);
        for (float side : {1 - eps, 1 + eps}) {
            glm::vec3 d(0);
            d[axis] = i < 8 ? (i & 1 ? 1.f : -1.f) : along;  // corners, too
            d[(axis + 1) % 3] = a * side;
            d[(axis + 2) % 3] = b;
            in.push_back({d, 16});
        }
    }
    const auto out = look_up(in);
    for (size_t i = 0; i < in.size(); i += 2)
        EXPECT_LT(glm::length(out[i].looked_up - out[i + 1].looked_up), 1e-5f) << i;
}

}  // namespace
}  // namespace peelray
