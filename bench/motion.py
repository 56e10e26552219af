#!/usr/bin/env python3
"""Renders scenes that move, frame after frame, and tabulates what each frame costs on the GPU.

    bench/motion.py --program build/release/peelray --models ../shared/models/skinned --out motion.json

Every row is a sequence at 1280x1024, one sample per pixel, four bounces, hard shadows, after a first frame that warms up. The
times are medians over the frames, and the least and the most of the whole frame. The frames go to a program that throws them
away in the place of ffmpeg: a GPU that idles while a picture is encoded lowers its clock. A scene is taken at --fps 30 and, with the
suffix "x10", at 3 frames a second: then all things move ten times as far from frame to frame. Scenes whose file is missing are
left out, with a line that says so.
"""
import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile

from scenes import chosen

SCENES = [  # name, file or built-in, options, seconds
    ("tiny, Walk", "tiny.glb", ["--animation", "Walk", "--floor", "--sky"], 1.0),
    ("walker", "builtin:walker", [], 7.6),
    ("waves 1M", "builtin:waves:1000000", [], 2.0),
    ("particles 3,000", "builtin:particles", [], 2.0),
    ("particles 100,000", "builtin:particles:100000", [], 0.5),
    ("blob 1M, swell", "builtin:blob:1000000", [], 1.0),
    ("blob 10M, swell, exact", "builtin:blob:10000000", ["--hit", "exact"], 1.0),
    ("blob 10M, swell, planar", "builtin:blob:10000000", ["--hit", "planar"], 1.0),
]
PARTS = ("animate", "build", "instances", "visibility", "trace", "shade", "frame")


def parts(frame):
    """Milliseconds by kind of work; `shade` is scatter and shadow, shadow rays included."""
    times = {part: 0.0 for part in PARTS}
    for entry in frame["passes"]:
        group, name = entry["name"].split("/")[0], entry["name"]
        if group in ("animate", "instances", "build"):
            times[group] += entry["ms"]
        elif name in ("visibility", "trace"):
            times[name] += entry["ms"]
        elif name.startswith("view_") or name == "fill visible triangles":
            times["visibility"] += entry["ms"]
        elif name.startswith(("scatter", "trace_shadow")):
            times["shade"] += entry["ms"]
    times["frame"] = frame["frame_ms"]
    return times


def sequence(program, scene, options, frames, fps, device):
    with tempfile.TemporaryDirectory() as folder:
        stats = os.path.join(folder, "stats.json")
        with open(os.path.join(folder, "ffmpeg"), "w") as sink:
            sink.write("#!/bin/sh\nfor last; do :; done\ncat > /dev/null\necho sink > \"${last#file:}\"\n")
        os.chmod(sink.name, 0o755)
        command = [program, "render", scene, "-o", os.path.join(folder, "f.mp4"), "--stats", stats, "--fps", str(fps),
                   "--frames", f"0:{frames}"] + (["--device", device] if device else [])
        done = subprocess.run(command + options, capture_output=True, text=True,
                              env=os.environ | {"PATH": folder + ":" + os.environ["PATH"]})
        if done.returncode != 0:
            return None, " ".join(done.stderr.strip().splitlines()[-1:])
        with open(stats) as file:
            return json.load(file), None


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default="build/release/peelray")
    parser.add_argument("--models", default="../shared/models/skinned")
    parser.add_argument("--out")
    parser.add_argument("--device")
    parser.add_argument("--only", help="scenes whose name contains this")
    parser.add_argument("--most", type=int, default=1000, help="frames of a sequence at most")
    arguments = parser.parse_args()
    rows = []
    print("| scene | triangles | hits | N | cubes: rebuilt, kept | instances moved | " + " | ".join(PARTS) + " | least to most |")
    print("|---" * 6 + "|---:" * (len(PARTS) + 1) + "|", flush=True)
    for name, scene, options, seconds in chosen(SCENES, arguments.models, arguments.only):
        for fps, suffix in ((30, ""), (3, ", x10")):
            frames = min(arguments.most, max(6, round(seconds * 30) + 1), 1000 if fps == 30 else 40)
            stats, error = sequence(arguments.program, scene, options, frames, fps, arguments.device)
            if error is not None:
                print(f"left out: {name}: {error}", file=sys.stderr)
                continue
            rows.append({"scene": name + suffix, "options": options, "fps": fps, "stats": stats})
            shown = [parts(frame) for frame in stats["frames"][1:]]
            median = {part: statistics.median(times[part] for times in shown) for part in PARTS}
            last = stats["frames"][-1]
            moved = last["moved"]
            print(f'| {name}{suffix} | {last["triangles"]:,} | {last["hit"]} | {last["ldc"]["n"]} | {moved["cubes_rebuilt"]}, '
                  f'{moved["cubes_reused"]} | {moved["instances_transformed"]} | '
                  + " | ".join(f"{median[part]:.3f}" for part in PARTS)
                  + f' | {min(t["frame"] for t in shown):.2f} to {max(t["frame"] for t in shown):.2f} |', flush=True)
    if arguments.out:
        with open(arguments.out, "w") as file:
            json.dump(rows, file, indent=1)


if __name__ == "__main__":
    main()
