// When and from where a picture is seen.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>

#include "motion/animation.h"

namespace peelray {

struct Shot {
    std::optional<double> time;  ///< of the animation, if there is one, seconds; none: where the scene is
    double fps = 30;             ///< frames that the animation has in a second; 0: it stands still
    /// Of the frame, from 0 at the animation's beginning; none: it follows from the moment.
    std::optional<int64_t> number;
    uint32_t turntable = 0;  ///< frames in which the camera goes once around its look point, see turned(); 0: it stays

    /// How far the camera has gone, in full circles.
    double turn() const { return turntable > 0 ? double(number.value_or(0)) / turntable : 0; }

    /// The shot with what follows from the moment that the scene is in, if it moves.
    Shot at(std::optional<double> moment) const {
        Shot shot = *this;
        shot.time = moment;
        // As moment_before() rounds.
        if (!number) shot.number = moment && fps > 0 ? int64_t(std::floor(*moment * fps + 1e-6)) : 0;
        return shot;
    }
    /// One frame earlier; of a shot that at() has completed. Before the animation's beginning all stands as it does
    /// there, but the camera of a turntable goes on.
    Shot before() const {
        Shot shot = *this;
        if (time && fps > 0) shot.time = moment_before(*time, fps);
        shot.number = number.value_or(0) - 1;
        return shot;
    }

    bool operator==(const Shot&) const = default;
};

}  // namespace peelray
