#include "workspace/culled_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/setting.h"
#include "scene/alpha_test.h"
#include "scene/sidedness.h"

namespace peelray {
namespace {

constexpr uint32_t kMostAcross = 48;

/// Camera rays through pixels that are spread evenly over a picture.
class Looks {
  public:
    Looks(const View& view, const PictureSettings& settings, const Picture& picture)
        : view_(view),
          columns_(std::min(settings.width, kMostAcross)),
          rows_(std::min(settings.height, kMostAcross)),
          settings_(settings) {
        for (uint32_t i = 0; i < columns_ * rows_; i++) {
            const glm::uvec2 at = pixel(i % columns_, i / columns_);
            state_.push_back(picture.radiance[size_t(at.y) * settings.width + at.x].w > 0 ? State::seen : State::empty);
        }
    }

    /// Marks the pixels that see nothing, and would see this triangle's back. `there(u, v)`: has it no hole?
    template <typename There>
    void offer(const std::array<glm::vec3, 3>& corners, const There& there) {
        glm::uvec2 first(0), last(columns_ - 1, rows_ - 1);
        if (!bounds(corners, first, last)) return;
        for (uint32_t y = first.y; y <= last.y; y++)
            for (uint32_t x = first.x; x <= last.x; x++) {
                State& state = state_[y * columns_ + x];
                if (state == State::empty && meets_back(corners, place(pixel(x, y)), there)) state = State::culled;
            }
    }

    double culled() const {
        return double(std::count(state_.begin(), state_.end(), State::culled)) / double(state_.size());
    }

  private:
    enum class State : uint8_t { empty, seen, culled };

    glm::uvec2 pixel(uint32_t column, uint32_t row) const {
        return {(2 * column + 1) * settings_.width / (2 * columns_), (2 * row + 1) * settings_.height / (2 * rows_)};
    }
    /// A pixel's centre in the picture, [-1, 1]², upwards.
    glm::dvec2 place(const glm::uvec2& pixel) const {
        return {(2.0 * pixel.x + 1) / settings_.width - 1, 1 - (2.0 * pixel.y + 1) / settings_.height};
    }

    /// The columns and rows that the triangle may cover; false: none.
    bool bounds(const std::array<glm::vec3, 3>& corners, glm::uvec2& first, glm::uvec2& last) const {
        glm::dvec2 lower(INFINITY), upper(-INFINITY);
        int ahead = 0;
        for (const glm::vec3& corner : corners) {
            const glm::dvec3 p = glm::dvec3(corner) - glm::dvec3(view_.eye), right(view_.right), up(view_.up);
            const double depth = glm::dot(p, glm::dvec3(view_.forward));
            ahead += depth > 0;
            const glm::dvec2 q =
                glm::dvec2(glm::dot(p, right) / glm::dot(right, right), glm::dot(p, up) / glm::dot(up, up)) /
                (view_.orthographic ? 1 : depth);
            lower = glm::min(lower, q);
            upper = glm::max(upper, q);
        }
        if (ahead == 0) return false;
        if (ahead < 3 && !view_.orthographic) return true;  // what reaches behind the eye may be anywhere
        if (upper.x < -1 || upper.y < -1 || lower.x > 1 || lower.y > 1) return false;
        const auto cell = [](double share, uint32_t count) {
            return uint32_t(std::clamp(std::floor(share * count), 0.0, count - 1.0));
        };
        // A cell's pixel is in its middle, or half a pixel beside.
        first = {cell(0.5 * lower.x + 0.5, columns_), cell(0.5 - 0.5 * upper.y, rows_)};
        last = {cell(0.5 * upper.x + 0.5, columns_), cell(0.5 - 0.5 * lower.y, rows_)};
        return true;
    }

    template <typename There>
    bool meets_back(const std::array<glm::vec3, 3>& corners, const glm::dvec2& at, const There& there) const {
        const glm::dvec3 offset = glm::dvec3(view_.right) * at.x + glm::dvec3(view_.up) * at.y, forward(view_.forward);
        const glm::dvec3 from = view_.orthographic ? glm::dvec3(view_.eye) + offset : glm::dvec3(view_.eye);
        const glm::dvec3 direction = view_.orthographic ? forward : forward + offset;
        const glm::dvec3 a(corners[0]), e = glm::dvec3(corners[1]) - a, f = glm::dvec3(corners[2]) - a;
        const glm::dvec3 normal = glm::cross(e, f), moment = glm::cross(direction, from - a);
        const double facing = glm::dot(normal, direction);
        if (!(facing > 0)) return false;  // its front, or edge-on
        const double t = glm::dot(normal, a - from) / facing;
        const double u = glm::dot(f, moment) / facing, v = -glm::dot(e, moment) / facing;
        return t > 0 && u >= 0 && v >= 0 && u + v <= 1 && there(u, v);
    }

    const View view_;
    const uint32_t columns_, rows_;
    const PictureSettings& settings_;
    std::vector<State> state_;
};

}  // namespace

double seen_share(const Picture& picture) {
    if (picture.seen) return *picture.seen;
    double sum = 0;
    for (const glm::vec4& pixel : picture.radiance) sum += double(pixel.w);
    return picture.radiance.empty() ? 0 : sum / double(picture.radiance.size());
}

double culled_share(const Scene& scene, const Geometry& geometry, const PictureSettings& settings,
                    const Picture& picture) {
    const float aspect = float(settings.width) / float(settings.height);
    const Box box = settings.bounds.value_or(Box{geometry.lower, geometry.upper});
    Looks looks(make_view(settings.camera, aspect, box.lower, box.upper), settings, picture);
    const Sidedness sides(scene, geometry);
    const AlphaTest alpha(scene, geometry);
    for (uint32_t i = 0; i < geometry.triangles.size(); i++) {
        if (!sides.is_single(i)) continue;
        const glm::uvec3 t = geometry.triangles[i];
        looks.offer({geometry.positions[t.x], geometry.positions[t.y], geometry.positions[t.z]},
                    [&](double u, double v) { return alpha.is_present(i, u, v); });
    }
    return looks.culled();
}

std::string culled_note(double seen, double culled) {
    // A few pixels of a lamp or a plant do not make the picture of a room.
    if (culled < 0.01 || seen > kMostSeenInNote * (seen + culled)) return {};
    return fmt::format(
        "{:.0f} % of the picture is empty because the camera is behind single-sided faces, as inside a room that is "
        "made to be seen from outside: {} shows them",
        100 * culled, setting::double_sided);
}

}  // namespace peelray
