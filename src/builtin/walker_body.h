// The shape that the figure's skin is made of. Private to src/builtin.
#pragma once

#include "builtin/soft_body.h"
#include "builtin/walker.h"

namespace peelray {

/// The parts of walker_body(), each with a material of its own; those after the bobble are painted onto others.
enum class Garment : uint8_t {
    trousers,
    boots,
    soles,
    jumper,
    mittens,
    scarf,
    skin,
    hair,
    cap,
    brim,
    bobble,
    stripes,
    cheeks,
    count
};

SoftBody walker_body();

}  // namespace peelray
