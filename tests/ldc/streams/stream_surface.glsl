// The surface that the test streams displace: height and normal over x.
float surfaceHeight(float x) { return 0.7 * x * (1.0 - x * x); }
vec3 surfaceNormal(float x) { return normalize(vec3(-0.7 * (1.0 - 3.0 * x * x), 0, 1)); }
