PeelrayCounts costSum(PeelrayCounts a, PeelrayCounts b) {
    return PeelrayCounts(a.steps + b.steps, a.cells + b.cells, a.pixels + b.pixels, a.samples + b.samples, a.triangles + b.triangles);
}
