// Twice the precision of a float, without bindings and without a device feature.
#ifndef PEELRAY_PRECISE_GLSL
#define PEELRAY_PRECISE_GLSL

// --- Numbers of twice the precision: the unevaluated sum x + y of two floats (Dekker 1971; Shewchuk 1997). They stand in
// where single precision cannot tell on which side of an edge a ray passes, and need no float64 feature. ---

vec2 peelrayTwoSum(float a, float b) {
    precise float s = a + b;
    precise float bb = s - a;
    precise float error = (a - (s - bb)) + (b - bb);
    return vec2(s, error);
}
/// Upper half of the bits of a float (Veltkamp).
float peelrayUpperHalf(float a) {
    precise float scaled = a * 4097.0;
    precise float upper = scaled - (scaled - a);
    return upper;
}
/// Not with fma(), which is free to round twice, and does on software devices.
vec2 peelrayTwoProduct(float a, float b) {
    precise float p = a * b;
    precise float ah = peelrayUpperHalf(a), bh = peelrayUpperHalf(b);
    precise float al = a - ah, bl = b - bh;
    precise float error = ((ah * bh - p) + ah * bl + al * bh) + al * bl;
    return vec2(p, error);
}
vec2 peelrayAdd(vec2 a, vec2 b) {
    const vec2 s = peelrayTwoSum(a.x, b.x), t = peelrayTwoSum(a.y, b.y);
    precise float low = s.y + t.x;
    const vec2 r = peelrayTwoSum(s.x, low);
    precise float rest = r.y + t.y;
    return peelrayTwoSum(r.x, rest);
}
vec2 peelrayMultiply(vec2 a, vec2 b) {
    const vec2 p = peelrayTwoProduct(a.x, b.x);
    precise float low = p.y + (a.x * b.y + a.y * b.x);
    return peelrayTwoSum(p.x, low);
}
/// a + b * c with a single rounding's error.
float peelrayFusedSum(vec2 a, float b, float c) {
    const vec2 r = peelrayAdd(a, peelrayTwoProduct(b, c));
    return r.x + r.y;
}

#endif
