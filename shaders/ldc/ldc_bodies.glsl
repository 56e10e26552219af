// Which body of a build a triangle, a 16x16x16 cell or a line of cells belongs to. Include after the buffer of bodies.
#ifndef PEELRAY_LDC_BODIES_GLSL
#define PEELRAY_LDC_BODIES_GLSL

// The last body of the build whose `member` does not exceed the value: bodies lie in ascending order, and the empty ones
// among them share theirs with the next.
#define LDC_SEARCH(function, member)                                            \
    uint function(uint value) {                                                 \
        uint first = params.first_body, count = params.bodies;                  \
        while (count > 1u) {                                                    \
            const uint half_count = count / 2u;                                 \
            const bool upper = bodies[first + half_count].member <= value;      \
            first += upper ? half_count : 0u;                                   \
            count = upper ? count - half_count : half_count;                    \
        }                                                                       \
        return first;                                                           \
    }

/// Of a triangle of the triangle buffer.
LDC_SEARCH(ldcBodyOfTriangle, first_triangle)
/// Of an entry of the table of 16x16x16 cells, or of a pixel.
LDC_SEARCH(ldcBodyOfCell, first_cell)
/// Of a line of ldc_sat_scan.
LDC_SEARCH(ldcBodyOfLineX, first_line.x)
LDC_SEARCH(ldcBodyOfLineY, first_line.y)
LDC_SEARCH(ldcBodyOfLineZ, first_line.z)

/// The body's first entry of the table of 16x16x16 cells, or its first pixel, counted from the build's first.
uint ldcFirstCell(uint body) { return bodies[body].first_cell - params.first_cell; }

#endif
