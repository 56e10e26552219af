// Media in the reference: what a path is inside of, and the next surface that is one to it (docs/frame.md section 4).
// Private to src/reference.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "path/shading_numbers.h"
#include "reference/intersections.h"
#include "reference/surface.h"
#include "scene/media.h"

namespace peelray::inline PRECISION {

/// Materials whose volumes a path has entered and not left, each as often as it has.
class Media {
  public:
    static constexpr uint32_t air = ~0u;

    Media() = default;
    Media(const Media& other)
        : few_(other.few_), count_(other.count_), more_(other.more_ ? std::make_unique<List>(*other.more_) : nullptr) {}
    Media(Media&&) = default;
    Media& operator=(const Media& other) { return *this = Media(other); }
    Media& operator=(Media&&) = default;

    uint32_t depth(uint32_t material) const;
    bool holds(uint32_t material) const { return depth(material) > 0; }
    void enter(uint32_t material);
    /// Without effect if the path is not in it.
    void leave(uint32_t material);
    /// How many there are.
    size_t kinds() const;
    /// The material whose medium counts, or air.
    uint32_t counting(const MediaRanks& ranks) const;

  private:
    using List = std::vector<uint32_t>;
    std::span<const uint32_t> entered() const { return more_ ? std::span(*more_) : std::span(few_).first(count_); }
    /// Each path has several: few materials are kept in place, all others in a list.
    std::array<uint32_t, 4> few_{};
    uint32_t count_ = 0;          ///< in `few_`
    std::unique_ptr<List> more_;  ///< all, if they were ever too many
};

/// What a ray meets.
struct Meeting {
    Hit hit;            ///< a miss: nothing
    bool wall = false;  ///< of a medium; if not, only `hit`, `before`, `behind`, `passed` and `beyond` have a meaning
    Media before, behind;
    uint32_t from = Media::air, to = Media::air;  ///< the media that count on either side
    Vec3 passed{1};                               ///< tint of walls on the way at which nothing changed
    Vec3 beside{1};                               ///< tint of the other walls at the same place
    real lift = 0;                                ///< how far from the wall rays start at least
    real beyond = 0;                              ///< where a ray that goes straight on has passed it
    uint32_t last = ~0u;                          ///< the triangle that it passes last
};

/// Finds what rays meet; all that it is made of must outlive it.
class MediaWalk {
  public:
    /// `crossed`: all that the ray meets which next() is asked for; null: it must be looked for.
    MediaWalk(const Intersections& triangles, const Surfaces& surfaces, const MediaRanks& ranks,
              const HitsAlong* crossed = nullptr)
        : triangles_(triangles), surfaces_(surfaces), ranks_(ranks), crossed_(crossed) {}

    /// `skip`: a triangle that does not count; `to_light`: see Intersections::nearest(); `first`: the nearest hit, if
    /// it is known.
    Meeting next(Ray ray, uint32_t skip, const Media& media, bool to_light = false, const Hit* first = nullptr) const;

  private:
    struct Wall {
        Hit hit;
        Face face;
    };
    bool bounds_medium(uint32_t triangle) const;
    Wall wall(const Hit& hit, const Ray& ray) const {
        return {hit, surfaces_.face_at(hit.triangle, hit.u, hit.v, ray.direction)};
    }
    /// What is in one place.
    struct Together {
        std::array<Wall, WALLS_TOGETHER> all;
        size_t count = 0;
        std::optional<Hit> opaque;
        std::span<const Wall> walls() const { return std::span(all).first(count); }
    };
    Hit nearest(const Ray& ray, uint32_t skip, bool to_light) const;
    Together walls_at(const Ray& ray, const Wall& nearest, const Media& media, bool to_light) const;
    size_t meet(const Ray& ray, std::span<const Wall> walls, Meeting& meeting) const;

    const Intersections& triangles_;
    const Surfaces& surfaces_;
    const MediaRanks& ranks_;
    const HitsAlong* crossed_;
};

}  // namespace peelray::inline PRECISION
