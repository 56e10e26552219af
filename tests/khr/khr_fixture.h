// Tests of the device's own ray tracing: skipped where it has none.
#pragma once

#include "gpu/device_fixture.h"

namespace peelray {

class KhrTest : public DeviceTest {
  protected:
    void SetUp() override {
        DeviceTest::SetUp();
        if (!device().features.ray_tracing)
            GTEST_SKIP() << "the device '" << device().info().name << "' has no ray tracing";
    }
};

}  // namespace peelray
