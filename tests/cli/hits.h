// What `peelray trace` writes.
#pragma once

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "image/npy.h"

namespace peelray {

/// The triangle of a ray that hits nothing.
constexpr uint32_t kMiss = 4294967295u;

/// The hits of a file's bytes; a test failure where it is no file of so many of them.
inline std::vector<HitRecord> hits_of(const std::string& file, size_t count) {
    const size_t body = file.find('\n') + 1;
    EXPECT_EQ(body % 64, 0u);
    EXPECT_TRUE(file.starts_with("\x93NUMPY"));
    EXPECT_NE(file.find("[('t', '<f4'), ('triangle', '<u4'), ('u', '<f4'), ('v', '<f4')]"), std::string::npos)
        << file.substr(0, body);
    EXPECT_NE(file.find("(" + std::to_string(count) + ",)"), std::string::npos) << file.substr(0, body);
    EXPECT_EQ(file.size() - body, count * sizeof(HitRecord));
    std::vector<HitRecord> hits(count);
    if (count) std::memcpy(hits.data(), file.data() + body, std::min(file.size() - body, count * sizeof(HitRecord)));
    return hits;
}

}  // namespace peelray
