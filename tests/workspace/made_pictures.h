// Comparisons of pictures that a workspace made.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "workspace/workspace.h"

namespace peelray {

inline void expect_identical(const MadePicture& a, const MadePicture& b) {
    const std::vector<glm::vec4>&left = a.picture.radiance, &right = b.picture.radiance;
    ASSERT_EQ(left.size(), right.size());
    EXPECT_EQ(std::memcmp(left.data(), right.data(), left.size() * sizeof(glm::vec4)), 0);
    EXPECT_EQ(a.picture.encoded, b.picture.encoded);
}

/// By cubes of other resolutions: exact hits are the same, but their t, u and v are rounded relative to the cube's
/// origin, which goes with its voxels.
inline void expect_same_picture(const MadePicture& a, const MadePicture& b) {
    const std::vector<glm::vec4>&left = a.picture.radiance, &right = b.picture.radiance;
    ASSERT_EQ(left.size(), right.size());
    for (size_t i = 0; i < left.size(); i++)
        for (int c = 0; c < 4; c++)
            ASSERT_LE(std::abs(left[i][c] - right[i][c]), 1e-4f) << i << " " << c;  // not so for NaN either
}

}  // namespace peelray
