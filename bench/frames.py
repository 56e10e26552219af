#!/usr/bin/env python3
"""Renders the paper's scenes (or their stand-ins) and tabulates where a frame's GPU time goes.

    bench/frames.py --program build/release/peelray --models ../shared/models/meshes --out frames.json

Every scene is mirror-like and stands on a mirroring floor, 1280x1024, one sample per pixel, four bounces, hard shadows; a
frame builds all its cubes anew (--keep: only what deforms, which is nothing here). Times are medians over the repeated frames
after a first one. Scenes whose file is missing are left out, with a line that says so.
"""
import argparse
import json
import os
import subprocess
import sys
import tempfile

from scenes import chosen

SCENES = [  # name, file or built-in, options
    ("bunny 7K", "bunny_7k.off", ["--material", "mirror", "--floor", "--sky"]),
    ("car 47K", "car2.glb", ["--floor", "--sky"]),
    ("dragon 101K", "chinesedragon.gltf", ["--material", "mirror", "--floor", "--sky"]),
    ("igea 269K", "igea.ply", ["--material", "mirror", "--floor", "--sky"]),
    ("teapots", "builtin:teapots", []),
    ("glass", "builtin:glass", []),
    ("tree", "builtin:tree", []),
    ("blob 1M", "builtin:blob:1000000", []),
    ("blob 10M", "builtin:blob:10000000", []),
]


def render(program, scene, options, repeat, device, rebuild):
    with tempfile.TemporaryDirectory() as folder:
        stats = os.path.join(folder, "stats.json")
        command = [program, "render", scene, "-o", os.path.join(folder, "picture.png"), "--stats", stats, "--repeat", str(repeat)]
        if rebuild:
            command.append("--rebuild")
        if device:
            command += ["--device", device]
        done = subprocess.run(command + options, capture_output=True, text=True)
        if done.returncode != 0:
            return None, done.stderr.strip().splitlines()[-1:]
        with open(stats) as file:
            return json.load(file), None


PARTS = ("visibility", "trace", "scatter", "shadow")


def part_of(name):
    """Which of PARTS a pass belongs to."""
    if name.startswith("view_") or name == "fill visible triangles":
        return "visibility"
    if name.startswith("scatter"):
        return "scatter"
    return "shadow" if name.startswith("trace_shadow") else name


def row(name, stats):
    passes = {}
    for p in stats["passes"]:
        passes[part_of(p["name"])] = passes.get(part_of(p["name"]), 0) + p["ms"]
    rate = stats["mrays_per_second"]
    secondary = stats["rays"]["reflection"] + stats["rays"]["refraction"]
    cells = [name, f'{stats["triangles"]}', f'{stats["ldc"]["n"]}', stats["hit"], f'{stats["build_ms"]:.3f}']
    for part in PARTS:
        cells.append(f"{passes.get(part, 0):.3f}")
    rest = stats["frame_ms"] - stats["build_ms"] - sum(passes.get(p, 0) for p in PARTS)
    cells += [f"{rest:.3f}", f'{stats["frame_ms"]:.3f}', f"{secondary / 1e6:.2f}", f'{rate["reflection_and_refraction"] or 0:.0f}',
              f'{stats["rays"]["shadow"] / 1e6:.2f}', f'{stats["ldc"]["bytes"] / 2**20:.1f}', f'{stats["memory_bytes"]["build_scratch"] / 2**20:.1f}']
    return "| " + " | ".join(cells) + " |"


HEAD = ("| scene | triangles | N | hits | build | visibility | trace | scatter | shadow | rest | frame | M secondary | Mrays/s | M shadow "
        "| cube MiB | scratch MiB |\n|" + "---|" * 17)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default="build/release/peelray")
    parser.add_argument("--models", default="../shared/models/meshes")
    parser.add_argument("--out")
    parser.add_argument("--repeat", type=int, default=20)
    parser.add_argument("--device")
    parser.add_argument("--keep", action="store_true", help="build the cubes once")
    parser.add_argument("--only", help="scenes whose name contains this")
    parser.add_argument("--sizes", default="512,1024", help="--ldc of each: auto or numbers")
    parser.add_argument("--hits", default="exact,planar")
    arguments = parser.parse_args()
    rows = []
    print(HEAD, flush=True)
    for name, scene, options in chosen(SCENES, arguments.models, arguments.only):
        for size in arguments.sizes.split(","):
            for hit in arguments.hits.split(","):
                stats, error = render(arguments.program, scene, options + ["--ldc", size, "--hit", hit], arguments.repeat, arguments.device, not arguments.keep)
                if error is not None:
                    print(f"left out: {name} {size} {hit}: {' '.join(error)}", file=sys.stderr)
                    continue
                rows.append({"scene": name, "options": options, "stats": stats})
                print(row(name, stats), flush=True)
    if arguments.out:
        with open(arguments.out, "w") as file:
            json.dump(rows, file, indent=1)


if __name__ == "__main__":
    main()
