// The doctor's picture: it passes where it should, and fails where it is another one or none at all.
#include "doctor/checked_frame.h"

#include <gtest/gtest.h>

#include "doctor/diagnosis.h"

namespace peelray {
namespace {

TEST(CheckedFrame, TheDeviceAndTheCpuPass) {
    std::string cause;
    const std::optional<Image8> expected = reference_frame(cause);
    ASSERT_TRUE(expected) << cause;
    EXPECT_EQ(expected->pixels.size(), size_t(kCheckedSize.x) * kCheckedSize.y);
    for (const Tracer tracer : {Tracer::ldc, Tracer::cpu}) {
        const CheckedFrame frame = check_frame(tracer, "", expected);
        EXPECT_TRUE(frame.passed) << frame.cause;
        EXPECT_EQ(frame.cause, "");
        EXPECT_GT(frame.frame_ms, 0);
        EXPECT_GT(frame.first_seconds, 0);
        EXPECT_LT(frame.different, 0.01);
        EXPECT_FALSE(frame.renderer.empty());
    }
}

TEST(CheckedFrame, AWrongPictureDoesNot) {
    std::string cause;
    std::optional<Image8> expected = reference_frame(cause);
    ASSERT_TRUE(expected);
    // One row of 72 is another's.
    for (uint32_t x = 0; x < expected->width; x++) expected->pixels[20 * expected->width + x] ^= 0x808080;
    const CheckedFrame frame = check_frame(Tracer::cpu, "", expected);
    EXPECT_FALSE(frame.passed);
    EXPECT_NE(frame.cause.find("1.4 % of the pixels"), std::string::npos) << frame.cause;
}

TEST(CheckedFrame, NoDeviceIsACause) {
    const CheckedFrame frame = check_frame(Tracer::ldc, "no such device", std::nullopt);
    EXPECT_FALSE(frame.passed);
    EXPECT_NE(frame.cause.find("no such device"), std::string::npos) << frame.cause;
}

TEST(VulkanStateTest, IsThatOfThisMachine) {
    const VulkanState state = vulkan_state();
    EXPECT_TRUE(state.loader);
    EXPECT_FALSE(state.devices.empty());
}

}  // namespace
}  // namespace peelray
