// From which side a view sees a triangle. Include after the buffers frame and instances.
#ifndef PEELRAY_VIEW_SIDE_GLSL
#define PEELRAY_VIEW_SIDE_GLSL

/// Does the view see the triangle's back? Its corners are relative to the eye. The same for all of the triangle, whose plane has the
/// eye on one side.
bool viewSeesBack(vec3 a, vec3 b, vec3 c, uint instance) {
    const vec3 along = frame[0].orthographic != 0u ? frame[0].forward : a;
    return dot(cross(b - a, c - a), along) >= 0.0 != (instances[instance].mirrored != 0u);
}

#endif
