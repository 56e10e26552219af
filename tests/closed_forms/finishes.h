// Surfaces of many kinds with what they send of light by their formulas, and means of what is drawn. Include after
// <pictures.h>.
#pragma once

#include "lobes.h"

namespace peelray {

/// A mean over pictures of several seeds, and its standard error.
struct Estimate {
    glm::dvec3 mean{0}, error{0};
    /// Four standard errors are exceeded by chance once in some thousand.
    void expect(const glm::dvec3& want, double tolerance) const {
        for (int k = 0; k < 3; k++)
            EXPECT_NEAR(mean[k], want[k], 4 * error[k] + tolerance * want[k]) << "colour " << k << ", " << error[k];
    }
};

/// A surface whose normal is +z, and what it sends to a viewer of light from a direction, times the cosine.
struct Finish {
    std::string name;
    Material material;
    std::function<glm::dvec3(const glm::dvec3& view, const glm::dvec3& to_light)> sends;
};

/// Cosine at which the tests look at them.
constexpr double kSlant = 0.6;

class DrawnLightTest : public PictureTest {
  protected:
    static Environment with_distribution(Environment environment) {
        environment.distribution = EnvironmentDistribution(environment);
        return environment;
    }
    static RenderSettings sampled_settings(const Camera& camera, uint32_t size, uint32_t spp = 1) {
        RenderSettings settings = settings_for(camera, size);
        settings.env_mode = EnvironmentMode::sampled;
        settings.spp = spp;
        return settings;
    }
    Estimate estimate(const Stage& stage, const Environment& environment, RenderSettings settings, uint32_t seeds) {
        Estimate all;
        glm::dvec3 squares(0);
        for (settings.seed = 0; settings.seed < seeds; settings.seed++) {
            const glm::dvec3 mean = mean_radiance(render(stage, environment, settings));
            all.mean += mean / double(seeds);
            squares += mean * mean / double(seeds);
        }
        all.error = glm::sqrt(glm::max(squares - all.mean * all.mean, glm::dvec3(0)) / (seeds - 1.0));
        return all;
    }
    static Stage square_of(const Material& material) {
        Stage stage;
        stage.add(brushed_square(), material);
        return stage;
    }
};

inline const glm::dvec3 kColor(0.8, 0.5, 0.2);

inline double above(const glm::dvec3& direction) {
    return std::max(direction.z, 0.0);
}
inline double v_h(const glm::dvec3& view, const glm::dvec3& to_light) {
    return glm::dot(view, glm::normalize(view + to_light));
}

inline Finish lambertian() {
    return {"diffuse", lambert(glm::vec3(kColor)),
            [](const glm::dvec3&, const glm::dvec3& l) { return kColor * above(l) / kPi; }};
}

inline Finish rough_metal(double roughness = 0.3) {
    Finish finish{"metal", metal("gold", glm::vec3(kColor)), {}};
    finish.material.roughness = float(roughness);
    finish.sends = [roughness](const glm::dvec3& v, const glm::dvec3& l) {
        if (l.z <= 0) return glm::dvec3(0);
        glm::dvec3 fresnel;
        for (int k = 0; k < 3; k++) fresnel[k] = schlick(kColor[k], 1, v_h(v, l));
        return fresnel * ggx_lobe(v, l, roughness);
    };
    return finish;
}

inline Finish dielectric(double roughness, double cosine) {
    Finish finish{"dielectric", lambert(glm::vec3(kColor)), {}};
    finish.material.roughness = float(roughness);
    finish.material.ior = 1.5f;
    const double left = 1 - ggx_mean(cosine, roughness, [](double c) { return fresnel(c, 1, 1.5); });
    finish.sends = [=](const glm::dvec3& v, const glm::dvec3& l) {
        if (l.z <= 0) return glm::dvec3(0);
        return fresnel(v_h(v, l), 1, 1.5) * ggx_lobe(v, l, roughness) + left * kColor * l.z / kPi;
    };
    return finish;
}

/// It lets no light through, so that only what it mirrors is seen.
inline Finish dark_glass() {
    Finish finish{"glass", thin_glass(), {}};
    finish.material.roughness = 0.3f;
    finish.material.base_color = glm::vec3(0);
    finish.sends = [](const glm::dvec3& v, const glm::dvec3& l) {
        if (l.z <= 0) return glm::dvec3(0);
        const double face = fresnel(v_h(v, l), 1, 1.5);
        return glm::dvec3(2 * face / (1 + face) * ggx_lobe(v, l, 0.3));
    };
    return finish;
}

inline Finish coated(double cosine) {
    const Finish below = rough_metal(0.6);
    Finish finish{"coat", below.material, {}};
    finish.material.clearcoat = 0.8f;
    finish.material.coat_roughness = 0.25f;
    const auto mirrored = [](double c) { return 0.8 * schlick(0.04, 1, c); };
    const double left = 1 - ggx_mean(cosine, 0.25, mirrored);
    finish.sends = [=](const glm::dvec3& v, const glm::dvec3& l) {
        if (l.z <= 0) return glm::dvec3(0);
        return left * below.sends(v, l) + mirrored(v_h(v, l)) * ggx_lobe(v, l, 0.25);
    };
    return finish;
}

inline Finish cloth(double cosine) {
    const glm::dvec3 color(0.3, 0.6, 0.9);
    Finish finish{"sheen", lambert(glm::vec3(kColor)), {}};
    finish.material.sheen_color = glm::vec3(color);
    finish.material.sheen_roughness = 0.5f;
    const double left = 1 - 0.9 * fibre_albedo(0.5, cosine);
    finish.sends = [=](const glm::dvec3& v, const glm::dvec3& l) {
        return l.z > 0 ? (left * kColor / kPi + color * fibres(0.5, v, l)) * l.z : glm::dvec3(0);
    };
    return finish;
}

inline Finish leaf_of_paper() {
    const glm::dvec3 behind(0.1, 0.6, 0.9);
    Finish finish{"seeping", lambert(glm::vec3(kColor)), {}};
    finish.material.diffuse_transmission = 0.25f;
    finish.material.diffuse_transmission_color = glm::vec3(behind);
    finish.sends = [=](const glm::dvec3&, const glm::dvec3& l) {
        return (l.z > 0 ? 0.75 * kColor * l.z : 0.25 * behind * -l.z) / kPi;
    };
    return finish;
}

inline Finish brushed_steel() {
    Finish finish{"stretched", metal("steel", glm::vec3(1)), {}};
    finish.material.roughness = 0.3f;
    finish.material.anisotropy = 0.6f;
    finish.material.anisotropy_rotation = 0.5f;
    finish.sends = [lobe = TwoWidths(0.3, 0.6, 0.5)](const glm::dvec3& v, const glm::dvec3& l) {
        return glm::dvec3(l.z > 0 ? lobe.lobe(v, l) : 0);
    };
    return finish;
}

inline std::vector<Finish> finishes(double cosine) {
    return {lambertian(),   rough_metal(), dielectric(0.4, cosine), dielectric(0.8, cosine), dark_glass(),
            coated(cosine), cloth(cosine), leaf_of_paper(),         brushed_steel()};
}

}  // namespace peelray
