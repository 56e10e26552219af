#!/usr/bin/env python3
"""Fingerprints of what the program writes: pictures, hits, statistics, messages.

    scripts/fingerprints.py PROGRAM OUT.json [--only TEXT] [--jobs N]
    scripts/fingerprints.py --compare BEFORE.json AFTER.json

A change that should change no picture is made between the two runs of the first form, on one device. Every built-in scene
is drawn by every tracer, and by every builder and traversal of the cube; rays from a file go through every hit test. Times,
memory, the commit and what rays cost (lists are in no fixed order) are left out of the statistics, for they differ from
run to run.
"""
import argparse
import concurrent.futures
import hashlib
import json
import random
import re
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

SCENES = ["teapots", "glass", "tree", "leaves", "room", "walker", "desk", "kitchen:3000", "bricks:3000", "cloth:2000", "blob:8000", "waves:2000",
          "particles:200"]
BUILDERS = ["compute", "abuffer", "peel"]
TRAVERSALS = ["voxel", "two-level", "mipmap"]
HITS = ["exact", "planar", "tolerance"]
VARYING = re.compile(r"(ms|seconds|second|bytes|commit|memory|times|passes|counters)$")


def cases():
    """Name -> arguments; {out} stands for the folder of what is written, {rays} for a file of rays."""
    size = ["--size", "64x48"]
    out = {}

    def render(name, scene, *more, picture="picture.exr"):
        if "--tracer" not in more:
            more += ("--tracer", "ldc")
        out[name] = ["render", f"builtin:{scene}", "-o", "{out}/" + picture, *size, "--stats", "{out}/stats.json", *more]

    for scene in SCENES:
        for tracer in ["cpu", "reference", "cubemap", "khr", "none"]:
            render(f"{scene} {tracer}", scene, "--tracer", tracer)
        for builder in BUILDERS:
            for traversal in TRAVERSALS:
                render(f"{scene} {builder} {traversal}", scene, "--builder", builder, "--traversal", traversal)
    for scene in ["teapots", "leaves", "blob:8000"]:
        for traversal in TRAVERSALS:
            for hit in HITS:
                render(f"{scene} {traversal} {hit}", scene, "--traversal", traversal, "--hit", hit, "--ldc", "128")
    for scene in ["teapots", "glass", "leaves"]:
        render(f"{scene} png", scene, "--spp", "2", picture="picture.png")
        render(f"{scene} ambient", scene, "--effects", "reflection,refraction,shadow,ambient", "--bounces", "2")
        render(f"{scene} no effects", scene, "--effects", "none")
        render(f"{scene} compute view", scene, "--visibility", "compute")
        render(f"{scene} counters", scene, "--counters", "--aov", "all", picture="picture.png")
        render(f"{scene} reference aovs", scene, "--tracer", "reference", "--aov", "depth,normal,albedo,position,triangle,material")
        for tracer in ["ldc", "cubemap", "reference"]:
            render(f"{scene} {tracer} background", scene, "--tracer", tracer, "--background", "0.2,0.4,1", "--floor")
    for material in ["mirror", "glass", "clay"]:
        render(f"blob {material}", "blob:2000", "--material", material, "--sky", "--exposure", "1", "--tonemap", "aces",
               picture="picture.png")
    for batch in ["layers", "rays"]:
        render(f"teapots {batch}", "teapots", "--traversal", "two-level", "--batch", batch, "--block", "4x8")
    render("teapots half depth", "teapots", "--traversal", "mipmap", "--depth", "16", "--hit", "planar")
    render("teapots draws", "teapots", "--builder", "abuffer", "--routing", "draws")
    render("glass repeat", "glass", "--repeat", "3", "--rebuild")
    render("glass camera", "glass", "--eye", "1,2,4", "--look", "0,0.5,0", "--up", "0,1,0.2", "--fov", "30")
    for scene in ["walker", "cloth:2000", "waves:2000", "particles:200"]:
        for tracer in ["ldc", "cubemap", "reference", "none"]:
            render(f"{scene} {tracer} moment", scene, "--tracer", tracer, "--time", "0.7")
        render(f"{scene} frames", scene, "--frames", "3:6", "--fps", "10", picture="frame_%02d.png")
        render(f"{scene} turntable", scene, "--turntable", "3", "--time", "0.5", picture="turn_%02d.exr")
    render("walker shard", "walker", "--frames", "0:4", "--shard", "1/2", "--aov", "depth,normal", picture="frame_%02d.png")
    out["compare"] = ["compare", "builtin:glass", "-o", "{out}/report.html", *size, "--json", "{out}/stats.json", "--tracers",
                      "cubemap,ldc,none,reference", "--hit", "exact,planar", "--strip", "{out}/strip.png", "--worst", "{out}/worst.png"]
    for scene in ["teapots", "walker", "leaves"]:
        for builder in BUILDERS:
            for traversal in TRAVERSALS:
                for hit in HITS:
                    if builder == "peel" and hit == "exact":
                        continue
                    out[f"trace {scene} {builder} {traversal} {hit}"] = [
                        "trace", f"builtin:{scene}", "--rays", "{rays}", "--out", "{out}/hits.npy", "--stats", "{out}/stats.json",
                        "--builder", builder, "--traversal", traversal, "--hit", hit, "--ldc", "96", "--tolerance", "0.05"]
    out["trace any"] = ["trace", "builtin:teapots", "--rays", "{rays}", "--out", "{out}/hits.npy", "--any-hit", "--counters",
                        "{out}/counters.npy", "--stats", "{out}/stats.json"]
    for scene in SCENES:
        out[f"info {scene}"] = ["info", f"builtin:{scene}"]
    return out


def write_rays(path, count=2000):
    """float32 (count, 8), from a sphere of 4 units inwards, the same every time."""
    rng = random.Random(7)
    rows = b""
    for _ in range(count):
        origin = [rng.gauss(0, 1) for _ in range(3)]
        norm = sum(x * x for x in origin) ** 0.5
        origin = [4 * x / norm for x in origin]
        target = [rng.uniform(-1.5, 1.5) for _ in range(3)]
        rows += struct.pack("<8f", *origin, 0.0, *[t - o for t, o in zip(target, origin)], 10.0)
    header = f"{{'descr': '<f4', 'fortran_order': False, 'shape': ({count}, 8), }}".encode()
    header += b" " * (63 - (10 + len(header)) % 64) + b"\n"
    path.write_bytes(b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header + rows)


def without_varying(value):
    """Statistics with their keys, less the values that no two runs share."""
    if isinstance(value, dict):
        return {k: "varies" if VARYING.search(k) else without_varying(v) for k, v in value.items()}
    if isinstance(value, list):
        return [without_varying(v) for v in value]
    return value


def run_case(program, name, arguments, rays):
    with tempfile.TemporaryDirectory() as folder:
        words = [a.replace("{out}", folder).replace("{rays}", str(rays)) for a in arguments]
        done = subprocess.run([program, *words], capture_output=True, text=True, timeout=600)
        found = {"status": done.returncode, "messages": done.stderr.replace(folder, "OUT").splitlines(), "files": {}}
        if name.startswith("info"):
            found["text"] = done.stdout
        for path in sorted(Path(folder).rglob("*")):
            if path.suffix == ".html" or path.name.endswith(".manifest.json") or re.search("counters|cost_", path.name):
                found["files"][path.name] = "there"
            elif path.suffix == ".json":
                found["files"][path.name] = without_varying(json.loads(path.read_text()))
            else:
                found["files"][path.name] = hashlib.sha256(path.read_bytes()).hexdigest()[:32]
        return name, found


def differences(before, after, where=""):
    if isinstance(before, dict) and isinstance(after, dict):
        for key in list(before) + [k for k in after if k not in before]:
            if key not in before or key not in after:
                yield f"{where}/{key}: only {'before' if key in before else 'after'}"
            else:
                yield from differences(before[key], after[key], f"{where}/{key}")
        if list(before) != list(after) and set(before) == set(after):
            yield f"{where}: another order"
    elif before != after:
        yield f"{where}: {before!r} -> {after!r}"


def compare(before_path, after_path):
    before, after = (json.loads(Path(p).read_text()) for p in (before_path, after_path))
    common = {k: before[k] for k in before if k in after}
    found = list(differences(common, {k: after[k] for k in common}))
    for line in found:
        print(line)
    files = sum(len(case["files"]) for case in common.values())
    print(f"{len(common)} cases, {files} files compared, {len(found)} differences; "
          f"{len(before) + len(after) - 2 * len(common)} cases in one of the two only")
    return 1 if found or not common else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("program", help="with --compare: the file of the build before")
    parser.add_argument("out", help="with --compare: the file of the build after")
    parser.add_argument("--compare", action="store_true")
    parser.add_argument("--only", default="", help="cases whose name holds this text")
    parser.add_argument("--jobs", type=int, default=2)
    a = parser.parse_args()
    if a.compare:
        return compare(a.program, a.out)
    with tempfile.TemporaryDirectory() as folder:
        rays = Path(folder) / "rays.npy"
        write_rays(rays)
        chosen = {k: v for k, v in cases().items() if a.only in k}
        with concurrent.futures.ThreadPoolExecutor(a.jobs) as pool:
            jobs = [pool.submit(run_case, a.program, k, v, rays) for k, v in chosen.items()]
            found = {}
            for job in concurrent.futures.as_completed(jobs):
                name, result = job.result()
                found[name] = result
                print(f"\r{len(found)}/{len(chosen)}", end="", file=sys.stderr)
    print(file=sys.stderr)
    Path(a.out).write_text(json.dumps({k: found[k] for k in chosen}, indent=1))
    failed = [k for k, v in found.items() if v["status"] != 0]
    print(f"{len(found)} cases, {sum(len(v['files']) for v in found.values())} files; {len(failed)} ended with an error: "
          f"{', '.join(failed)}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
