#include "reference/media.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "path/shading_numbers.h"

namespace peelray::inline PRECISION {

uint32_t Media::depth(uint32_t material) const {
    return uint32_t(std::ranges::count(entered(), material));
}

void Media::enter(uint32_t material) {
    if (!more_ && count_ < few_.size()) {
        few_[count_++] = material;
        return;
    }
    if (!more_) more_ = std::make_unique<List>(few_.begin(), few_.end());
    more_->push_back(material);
}

void Media::leave(uint32_t material) {
    const auto at = std::ranges::find(entered(), material) - entered().begin();
    if (at == std::ptrdiff_t(entered().size())) return;
    if (more_) {
        more_->erase(more_->begin() + at);
        return;
    }
    std::copy(few_.begin() + at + 1, few_.begin() + count_, few_.begin() + at);
    count_--;
}

size_t Media::kinds() const {
    size_t kinds = 0;
    const auto all = entered();
    for (size_t i = 0; i < all.size(); i++) kinds += std::ranges::find(all.first(i), all[i]) == all.first(i).end();
    return kinds;
}

uint32_t Media::counting(const MediaRanks& ranks) const {
    uint32_t first = air;
    for (const uint32_t material : entered())
        if (first == air || ranks.of_material[material] < ranks.of_material[first]) first = material;
    return first;
}

bool MediaWalk::bounds_medium(uint32_t triangle) const {
    return ranks_.of_material[surfaces_.material_of_triangle(triangle)] != MediaRanks::none;
}

Hit MediaWalk::nearest(const Ray& ray, uint32_t skip, bool to_light) const {
    if (!crossed_) return triangles_.nearest(ray, skip, to_light);
    for (const Hit& hit : crossed_->hits())
        if (hit.t > ray.tmin && hit.t <= ray.tmax && hit.triangle != skip) return hit;
    return {};
}

/// The walls that are one with the nearest, which comes first: as long as the ray meets parallel walls of media next. A
/// body's wall counts once, also where two of its triangles meet; a body that the ray enters here it does not leave.
/// What is opaque hides walls that coincide with it.
MediaWalk::Together MediaWalk::walls_at(const Ray& ray, const Wall& nearest, const Media& media, bool to_light) const {
    Together together;
    together.all[together.count++] = nearest;
    const real slope = std::max(std::abs(glm::dot(nearest.face.geometric, ray.direction)), LEAST_COSINE);
    const real reach = WALLS_APART * nearest.face.extent / slope + nearest.hit.t * distance_rounding;
    const Ray near{ray.origin, std::max(ray.tmin, nearest.hit.t - reach), ray.direction, nearest.hit.t + reach};
    const uint32_t skip = nearest.hit.triangle;
    HitsAlong found;
    if (!crossed_) found = triangles_.along(near, skip, to_light);
    for (const Hit& hit : crossed_ ? crossed_->hits() : std::as_const(found).hits()) {
        if (crossed_ && (hit.t <= near.tmin || hit.triangle == skip)) continue;
        if (together.count == together.all.size() || hit.t > near.tmax) break;
        const Wall next = wall(hit, ray);
        const uint32_t material = next.face.material;
        if (std::abs(glm::dot(next.face.geometric, nearest.face.geometric)) < WALLS_PARALLEL) break;
        if (!bounds_medium(hit.triangle)) {
            if (!surfaces_.lets_through(material)) together.opaque = hit;
            break;
        }
        const auto same = [&](bool front) {
            return std::ranges::any_of(together.walls(), [&](const Wall& other) {
                return other.face.material == material && other.face.front == front;
            });
        };
        if (same(next.face.front)) continue;
        if (same(!next.face.front) && !media.holds(material)) break;
        together.all[together.count++] = next;
    }
    return together;
}

/// What walls at the same place are to a ray: it enters before it leaves, and what it leaves without having entered it
/// was there. Returns the wall that decides how the surface looks.
size_t MediaWalk::meet(const Ray& ray, std::span<const Wall> walls, Meeting& meeting) const {
    Media assumed = meeting.before;
    for (const Wall& wall : walls)
        if (!wall.face.front && !meeting.before.holds(wall.face.material)) assumed.enter(wall.face.material);
    Media behind = assumed;
    for (const Wall& wall : walls)
        if (wall.face.front) behind.enter(wall.face.material);
    for (const Wall& wall : walls)
        if (!wall.face.front) behind.leave(wall.face.material);
    meeting.from = assumed.counting(ranks_);
    meeting.to = behind.counting(ranks_);
    size_t owner = 0;
    uint32_t least = MediaRanks::none;
    for (size_t i = 0; i < walls.size(); i++) {
        const uint32_t material = walls[i].face.material, rank = ranks_.of_material[material];
        if ((material != meeting.from && material != meeting.to) || rank >= least) continue;
        owner = i;
        least = rank;
    }
    meeting.beside = Vec3(1);
    for (size_t i = 0; i < walls.size(); i++) {
        const auto& [hit, face] = walls[i];
        // The wall of a body within another one of the same medium has no colour.
        const bool inner = assumed.holds(face.material) && behind.holds(face.material);
        if (!inner && (i != owner || meeting.from == meeting.to))
            meeting.beside *= surfaces_.at(hit.triangle, hit.u, hit.v, ray.direction).optics.tint();
    }
    meeting.behind = std::move(behind);
    return owner;
}

Meeting MediaWalk::next(Ray ray, uint32_t skip, const Media& media, bool to_light, const Hit* first) const {
    Meeting meeting;
    meeting.before = media;
    for (int i = 0;; i++) {
        meeting.hit = i == 0 && first ? *first : nearest(ray, skip, to_light);
        meeting.wall = meeting.hit.hit() && bounds_medium(meeting.hit.triangle);
        meeting.beyond = meeting.hit.t;
        meeting.last = meeting.hit.triangle;
        if (!meeting.wall) {
            meeting.behind = meeting.before;
            return meeting;
        }
        const Together together = walls_at(ray, wall(meeting.hit, ray), meeting.before, to_light);
        if (together.opaque) {
            meeting.hit = *together.opaque;
            meeting.wall = false;
            meeting.behind = meeting.before;
            return meeting;
        }
        const std::span<const Wall> walls = together.walls();
        const size_t owner = meet(ray, walls, meeting);
        for (const Wall& wall : walls) {
            if (wall.hit.t < meeting.beyond) continue;
            meeting.beyond = wall.hit.t;
            meeting.last = wall.hit.triangle;
        }
        if (meeting.from != meeting.to || i >= WALLS_PASSED) {
            if (walls.size() > 1)
                meeting.lift = WALLS_LIFT * WALLS_APART * std::max(walls[0].face.extent, walls[owner].face.extent);
            meeting.hit = walls[owner].hit;
            return meeting;
        }
        meeting.passed *= meeting.beside;
        meeting.before = meeting.behind;
        ray.tmin = meeting.beyond;
        skip = meeting.last;
    }
}

}  // namespace peelray::inline PRECISION
