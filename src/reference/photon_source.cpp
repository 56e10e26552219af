// How lamps send photons.
#include <algorithm>
#include <cmath>

#include "reference/lamp_shape.h"
#include "reference/optics.h"
#include "reference/photon_flight.h"

namespace peelray::inline PRECISION {

using namespace optics;

namespace {

/// 1 less the cosine of an angle.
real narrowness(real sine) {
    return sine * sine / (1 + std::sqrt(std::max(real(0), 1 - sine * sine)));
}

/// Evenly from the cone around an axis; `narrow`: 1 less the cosine of its half angle.
Vec3 in_cone(const Vec3& axis, real narrow, const Vec2& random) {
    const real off = random.x * narrow, sine = std::sqrt(off * (2 - off)), phi = 2 * real(pi) * random.y;
    const auto [t, b] = tangents(axis);
    return axis * (1 - off) + (t * std::cos(phi) + b * std::sin(phi)) * sine;
}

Vec3 on_disc(const Vec3& normal, real radius, const Vec2& random) {
    const auto [t, b] = tangents(normal);
    const real r = radius * std::sqrt(random.x), phi = 2 * real(pi) * random.y;
    return (t * std::cos(phi) + b * std::sin(phi)) * r;
}

/// A line, or the half of it from `origin` on.
struct Line {
    Vec3 origin, direction;
    bool is_whole;
    bool meets(const Vec3& centre, real radius) const {
        const Vec3 way = centre - origin;
        if (!is_whole && glm::dot(way, direction) <= 0 && glm::dot(way, way) > radius * radius) return false;
        const Vec3 beside = glm::cross(way, direction);
        return glm::dot(beside, beside) <= radius * radius;
    }
};

/// Sends one photon.
class Source {
  public:
    Source(const RenderContext& context, const PhotonPlan& plan, const PhotonPass& pass, uint32_t number)
        : plan_(plan), pass_(pass), number_(number), lamp_(choose_lamp()), light_(context.lights[lamp_.light]) {
        random_ = random(RANDOM_PHOTON_TARGET);
        target_ = choose_target();
        radius_ = is_sampled(context.settings) ? real(light_.radius) : 0;
    }

    SentPhoton send() const {
        SentPhoton photon = light_.kind == Light::Kind::directional ? from_afar() : from_place();
        photon.light = &light_;
        photon.flux *= Vec3(light_.color) * real(lamp_.weight);
        return photon;
    }

  private:
    Vec2 random(uint32_t purpose) const {
        return random_pair(pass_.seed, 0, purpose, {number_, pass_.bits, pass_.picture});
    }

    const PhotonLamp& choose_lamp() const {
        const uint64_t place = uint64_t(number_) << 32 | pass_.offset;
        for (const PhotonLamp& lamp : plan_.lamps)
            if (uint64_t(lamp.threshold) * plan_.photons > place) return lamp;
        return plan_.lamps.back();
    }

    /// What the number that chooses leaves of itself chooses where.
    size_t choose_target() {
        const uint32_t number = uint32_t(random_.x * 16777216) << 8;
        const auto first = plan_.thresholds.begin() + lamp_.first, end = first + ptrdiff_t(plan_.targets.size());
        const auto chosen = std::upper_bound(first, end - 1, number);
        const uint32_t before = chosen == first ? 0 : *(chosen - 1);
        random_.x = std::min(real(number - before) / real(*chosen - before), below_one);
        return size_t(chosen - first);
    }

    real weight_of(const Line& line, real grown) const {
        real sum = 0;
        for (size_t k = 0; k < plan_.targets.size(); k++) {
            const PhotonTarget& target = plan_.targets[k];
            if (k == target_ || line.meets(target.centre, real(target.radius) + grown)) sum += real(target.share);
        }
        return sum;
    }

    SentPhoton from_afar() const {
        const PhotonTarget& target = plan_.targets[target_];
        SentPhoton photon{{}, light_.direction, Vec3(1), nullptr};
        if (radius_ > 0) {
            const real narrow = narrowness(std::sin(radius_));
            photon.direction = -in_cone(-photon.direction, narrow, random(RANDOM_PHOTON_LAMP));
            photon.flux *= 2 / (2 - narrow);
        }
        photon.origin = Vec3(target.centre) + on_disc(photon.direction, real(target.radius), random_);
        photon.flux /= weight_of({photon.origin, photon.direction, true}, 0);
        const real past = glm::dot(photon.origin - Vec3(plan_.centre), photon.direction);
        photon.origin -= photon.direction * (past + real(plan_.reach));
        return photon;
    }

    SentPhoton from_place() const {
        const PhotonTarget& target = plan_.targets[target_];
        const Vec3 position = light_.position, way = Vec3(target.centre) - position;
        const real distance = glm::length(way), sine = (real(target.radius) + radius_) / distance;
        SentPhoton photon{position, {}, Vec3(1), nullptr};
        if (sine >= 1 || distance == 0)
            photon.direction = in_cone({0, 0, 1}, 2, random_);
        else
            photon.direction = in_cone(way / distance, narrowness(sine), random_);
        photon.flux /= weight_of({position, photon.direction, false}, radius_);
        if (radius_ > 0) {
            const Vec3 off = on_disc(photon.direction, radius_, random(RANDOM_PHOTON_LAMP));
            photon.origin += off + photon.direction * std::sqrt(radius_ * radius_ - glm::dot(off, off));
        }
        photon.flux *= within_cone(light_, photon.direction);
        return photon;
    }

    const PhotonPlan& plan_;
    const PhotonPass& pass_;
    uint32_t number_;
    const PhotonLamp& lamp_;
    const Light& light_;
    Vec2 random_{0};
    size_t target_ = 0;
    real radius_ = 0;  ///< of the lamp; of the sun in radians
};

}  // namespace

SentPhoton send_photon(const RenderContext& context, const PhotonPlan& plan, const PhotonPass& pass, uint32_t number) {
    return Source(context, plan, pass, number).send();
}

}  // namespace peelray::inline PRECISION
