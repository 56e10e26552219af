// What every comparison of two pictures asks first. Private to src/image.
#pragma once

#include <cassert>
#include <cstddef>

#include "base/error.h"

namespace peelray {

/// Throws Error, naming both sizes, if the pictures differ in size or have no pixels.
template <typename A, typename B>
void check_same_size(const A& reference, const B& test) {
    if (reference.width != test.width || reference.height != test.height)
        fail("cannot compare pictures of different sizes: the reference has {}x{} pixels, the other {}x{}",
             reference.width, reference.height, test.width, test.height);
    if (reference.width == 0 || reference.height == 0)
        fail("cannot compare pictures without pixels: both are {}x{}", reference.width, reference.height);
    assert(reference.pixels.size() == size_t(reference.width) * reference.height);
    assert(test.pixels.size() == size_t(test.width) * test.height);
}

}  // namespace peelray
