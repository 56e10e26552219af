#include "scene/photons.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <set>

#include "scene/probabilities.h"

namespace peelray {
namespace {

constexpr double pi = std::numbers::pi;

/// Of a number that is to look like no other one (Wellons's lowbias32).
uint32_t mixed(uint32_t v) {
    v = (v ^ v >> 16) * 0x7feb352du;
    v = (v ^ v >> 15) * 0x846ca68bu;
    return v ^ v >> 16;
}

/// Weight of directions to a material's surface; 0: photons end there.
float share_of(const Scene& scene, const Material& m, const PictureSettings& settings) {
    const bool refracts = settings.refraction && settings.shadow;
    if (m.unlit || m.catcher) return 0;
    if (transmits(m) && (refracts || settings.reflection)) return 1;
    const bool metal = m.metallic > float(MOSTLY_METAL);
    // A coat that mirrors is no metal.
    if (!settings.reflection || !is_reflection_traced(least_roughness(scene, m), metal, 2)) return 0;
    return m.ior == 0 ? 1 : std::max(float(PHOTON_LEAST_SHARE), m.metallic);
}

PhotonTarget ball_around(const Box& box, float share) {
    return {0.5f * (box.lower + box.upper), 0.5f * glm::length(box.upper - box.lower), share};
}

/// Finds targets in geometry: runs of triangles of one object and one material.
class Targets {
  public:
    Targets(const Scene& scene, const Geometry& geometry, const PictureSettings& settings)
        : scene_(scene), geometry_(geometry) {
        for (const Material& material : scene.materials) shares_.push_back(share_of(scene, material, settings));
    }

    std::vector<PhotonTarget> find() {
        std::set<int> generated;
        for (const Water& water : scene_.generated.waters) {
            generated.insert(water.node);
            for (const Water::Float& f : water.floats) generated.insert(f.node);
        }
        for (const Cloth& cloth : scene_.generated.cloths) generated.insert(cloth.node);
        for (const Swarm& swarm : scene_.generated.swarms) generated.insert(swarm.nodes.begin(), swarm.nodes.end());
        float anywhere = 0;
        size_t object = 0;
        for (size_t n = 0; n < scene_.nodes.size(); n++) {
            if (!has_triangles(scene_.nodes[n])) continue;
            const Geometry::Object& o = geometry_.objects[object++];
            if (!generated.contains(int(n)))
                add(o);
            else
                for (uint32_t t = o.first; t < o.first + o.count; t++)
                    anywhere = std::max(anywhere, shares_[geometry_.materials[t]]);
        }
        const auto& reach = scene_.generated.reach;
        if (anywhere > 0) targets_.push_back(ball_around({reach.lower, reach.upper}, anywhere));
        merge();
        return targets_;
    }

  private:
    bool has_triangles(const Node& node) const {
        return node.mesh >= 0 && std::ranges::any_of(scene_.meshes[size_t(node.mesh)].primitives,
                                                     [](const Primitive& p) { return !p.triangles.empty(); });
    }

    void add(const Geometry::Object& object) {
        for (uint32_t first = object.first, end = object.first + object.count; first < end;) {
            uint32_t last = first;
            while (last < end && geometry_.materials[last] == geometry_.materials[first]) last++;
            const float share = shares_[geometry_.materials[first]];
            if (share > 0) add(first, last, share);
            first = last;
        }
    }

    void add(uint32_t first, uint32_t end, float share) {
        Box box;
        const auto each_corner = [&](const auto& visit) {
            for (uint32_t t = first; t < end; t++)
                for (int k = 0; k < 3; k++) visit(geometry_.positions[geometry_.triangles[t][k]]);
        };
        each_corner([&](const glm::vec3& p) { box.add(p); });
        PhotonTarget target = ball_around(box, share);
        double farthest = 0;
        each_corner([&](const glm::vec3& p) {
            const glm::dvec3 way = glm::dvec3(p) - glm::dvec3(target.centre);
            farthest = std::max(farthest, glm::dot(way, way));
        });
        target.radius = float(std::sqrt(farthest) * 1.0001);
        if (target.radius > 0) targets_.push_back(target);
    }

    /// The larger dimension is cut in the middle until there are few enough: balls that are close to each other become
    /// one.
    void merge() {
        if (targets_.size() <= PHOTON_MOST_TARGETS) return;
        std::vector<PhotonTarget> merged;
        merge(targets_, PHOTON_MOST_TARGETS, merged);
        targets_ = std::move(merged);
    }

    static void merge(std::span<PhotonTarget> targets, size_t most, std::vector<PhotonTarget>& merged) {
        Box centres, box;
        float share = 0;
        for (const PhotonTarget& t : targets) {
            centres.add(t.centre);
            box.add(t.centre - t.radius);
            box.add(t.centre + t.radius);
            share = std::max(share, t.share);
        }
        if (most == 1 || targets.size() == 1) {
            PhotonTarget ball = ball_around(box, share);
            ball.radius = 0;
            for (const PhotonTarget& t : targets)
                ball.radius = std::max(ball.radius, 1.0001f * (glm::length(t.centre - ball.centre) + t.radius));
            return merged.push_back(targets.size() == 1 ? targets[0] : ball);
        }
        const glm::vec3 size = centres.upper - centres.lower;
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        std::ranges::stable_sort(targets, {}, [&](const PhotonTarget& t) { return t.centre[axis]; });
        const size_t half = targets.size() / 2;
        merge(targets.first(half), most / 2, merged);
        merge(targets.subspan(half), most - most / 2, merged);
    }

    const Scene& scene_;
    const Geometry& geometry_;
    std::vector<float> shares_;  ///< by material
    std::vector<PhotonTarget> targets_;
};

/// What a target fills of all that a lamp shines on: a solid angle or, far away, an area.
double seen_from(const Light& light, double lamp_radius, const PhotonTarget& target) {
    if (light.kind == Light::Kind::directional) return pi * target.radius * target.radius;
    const glm::dvec3 way = glm::dvec3(target.centre) - glm::dvec3(light.position);
    const double distance = glm::length(way), radius = target.radius + lamp_radius;
    if (distance <= radius) return 4 * pi;
    const double sine = radius / distance;
    if (light.kind == Light::Kind::spot) {
        const double off = std::acos(std::clamp(glm::dot(way / distance, glm::dvec3(light.direction)), -1.0, 1.0));
        // The ramp ends within a thousandth of the cosine, where both cones are one.
        if (off > double(light.outer_cone) + std::asin(sine) + 0.05) return 0;
    }
    return 2 * pi * sine * sine / (1 + std::sqrt(1 - sine * sine));
}

/// Shares of a sum as whole numbers; `one` stands for all.
std::vector<uint32_t> thresholds_of(const std::vector<double>& weights, double one) {
    double sum = 0, so_far = 0;
    for (const double w : weights) sum += w;
    std::vector<uint32_t> out;
    for (const double w : weights) out.push_back(uint32_t(std::min((so_far += w) / sum * one, 4294967295.0)));
    return out;
}

void add_lamps(PhotonPlan& plan, std::span<const Light> lights, const PictureSettings& settings) {
    std::vector<double> powers;
    std::vector<double> seen;
    for (uint32_t i = 0; i < lights.size(); i++) {
        const Light& light = lights[i];
        const double radius = is_sampled(settings) ? double(light.radius) : 0;
        std::vector<double> weights;
        double sum = 0;
        for (const PhotonTarget& target : plan.targets) {
            weights.push_back(target.share * seen_from(light, radius, target));
            sum += weights.back();
        }
        const double power = mean_color(glm::abs(glm::dvec3(light.color))) * sum;
        if (!(power > 0) || !std::isfinite(power)) continue;
        plan.lamps.push_back({i, 0, 0, uint32_t(plan.thresholds.size())});
        const std::vector<uint32_t> thresholds = thresholds_of(weights, 4294967295.0);
        plan.thresholds.insert(plan.thresholds.end(), thresholds.begin(), thresholds.end());
        plan.thresholds.back() = ~0u;
        powers.push_back(power);
        seen.push_back(sum);
        plan.flux += power / plan.photons;
    }
    const std::vector<uint32_t> thresholds = thresholds_of(powers, 4294967296.0);
    for (size_t k = 0; k < powers.size(); k++) {
        plan.lamps[k].threshold = thresholds[k];
        const double end = k + 1 < powers.size() ? thresholds[k] : 4294967296.0, first = k > 0 ? thresholds[k - 1] : 0;
        if (end > first) plan.lamps[k].weight = float(seen[k] / (plan.photons * ((end - first) / 4294967296.0)));
    }
}

}  // namespace

PhotonPlan plan_photons(const Scene& scene, const Geometry& geometry, std::span<const Light> lights,
                        const PictureSettings& settings) {
    PhotonPlan plan;
    plan.through_glass = settings.refraction && settings.shadow;
    if (settings.caustics == 0 || settings.bounces == 0 || !(settings.reflection || plan.through_glass)) return plan;
    plan.targets = Targets(scene, geometry, settings).find();
    if (plan.targets.empty()) return plan;
    plan.photons = settings.caustics;
    plan.box = {geometry.lower, geometry.upper};
    if (!scene.generated.empty()) {
        plan.box.add(scene.generated.reach.lower);
        plan.box.add(scene.generated.reach.upper);
    }
    plan.centre = 0.5f * (plan.box.lower + plan.box.upper);
    plan.reach = 0.505f * glm::length(plan.box.upper - plan.box.lower);
    add_lamps(plan, lights, settings);
    if (plan.lamps.empty()) return {};
    double squares = 0;
    for (const PhotonTarget& t : plan.targets) squares += double(t.share) * t.radius * t.radius;
    plan.radius =
        std::min(std::sqrt(PHOTON_GATHERED * squares / plan.photons), PHOTON_MOST_RADIUS * double(plan.reach));
    return plan;
}

PhotonPass photon_pass(const PhotonPlan& plan, const PictureSettings& settings, uint32_t sample) {
    PhotonPass pass{};
    pass.seed = sample << RANDOM_BRANCH_BITS;
    pass.bits = uint32_t(std::bit_width(plan.photons - 1));
    // Sobol's sequence has 2^32 points: further passes take another one.
    const uint32_t sequence = uint32_t(uint64_t(sample) << pass.bits >> 32);
    pass.picture = mixed(mixed(settings.seed) + RANDOM_PHOTON_TARGET + sequence);
    pass.offset = mixed(pass.picture + sample);
    // The product of (i + a) / (i + 1) over the passes before.
    const double a = PHOTON_SHRINKING, i = sample + 1.0;
    pass.radius = float(plan.radius * std::exp(0.5 * (std::lgamma(i + a) - std::lgamma(1 + a) - std::lgamma(i + 1))));
    return pass;
}

}  // namespace peelray
