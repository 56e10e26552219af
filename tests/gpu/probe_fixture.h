// Running a probe: a shader of tests/gpu/probes that maps an array of inputs to an array of outputs.
#pragma once

#include <random>
#include <span>
#include <string_view>
#include <vector>

#include <glm/glm.hpp>

#include "gpu/device_fixture.h"
#include "gpu/shader_table.h"

namespace peelray {

std::span<const EmbeddedShader> probe_shaders();

inline void register_probes() {
    static const bool once = [] {
        register_shaders(probe_shaders());
        return true;
    }();
    (void)once;
}

class ProbeTest : public DeviceTest {
  protected:
    void SetUp() override {
        register_probes();
        DeviceTest::SetUp();
    }

    /// outputs[i] = probe(inputs[i]). Out and In must be what the shader declares (scalar layout: no padding).
    template <typename Out, typename In>
    std::vector<Out> probe(std::string_view shader, const std::vector<In>& inputs, const Constants& constants = {}) {
        const Buffer in = upload(inputs), out(device(), "probe results", inputs.size() * sizeof(Out));
        commands().run(device().pass(shader, constants), {{"inputs", in}, {"outputs", out}}, uint32_t(inputs.size()),
                       groups_for(inputs.size(), 64));
        return download<Out>(out, inputs.size());
    }

    /// The same numbers on every machine, unlike the standard distributions.
    double uniform(double low, double high) { return low + (high - low) * (double(random_()) / 4294967296.0); }
    uint32_t bits() { return uint32_t(random_()); }
    glm::vec3 point(double low, double high) {
        const double x = uniform(low, high), y = uniform(low, high), z = uniform(low, high);
        return glm::vec3(x, y, z);
    }
    glm::dvec3 unit() {
        const double z = uniform(-1, 1), phi = uniform(0, 2 * 3.14159265358979323846), r = std::sqrt(1 - z * z);
        return {r * std::cos(phi), r * std::sin(phi), z};
    }

  private:
    std::mt19937 random_{12345};
};

}  // namespace peelray
