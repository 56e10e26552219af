#!/usr/bin/env bash
# figures.sh [PROGRAM [readme]]: makes the pictures of docs/, with the program itself; with "readme" those of README.md, too,
# which have so many samples that they want a GPU (or half an hour).
set -euo pipefail
cd "$(dirname "$0")/.."
program=${1:-build/release/peelray}
[ -x "$program" ] || { echo "figures: there is no $program: run 'make build' first" >&2; exit 1; }
python3 -c 'import numpy' 2> /dev/null || { echo "figures: python3 or its numpy is missing: apt-get install python3-numpy" >&2; exit 1; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# figure NAME SCENE OPTIONS...: docs/NAME.png
figure() {
    local name=$1 scene=$2
    shift 2
    "$program" render "$scene" -o "docs/$name.png" --size 400x320 --spp 4 --tracer ldc "$@"
}

# The auxiliary pictures are EXR files of 32-bit floats; this turns one into a PNG that a browser shows.
aov_to_png() {  # KIND FILE.exr FILE.png
    python3 - "$@" << 'PYTHON'
import struct, sys, zlib

sys.path.insert(0, "bench")
from exr import read

kind, source, target = sys.argv[1:]
pictures = read(source)
planes = {channel: picture.ravel().tolist() for channel, picture in pictures.items()}
height, width = next(iter(pictures.values())).shape

srgb = lambda v: round(255 * (12.92 * v if v <= 0.0031308 else 1.055 * min(v, 1.0) ** (1 / 2.4) - 0.055))
if kind == "albedo":
    pixels = [tuple(map(srgb, p)) for p in zip(planes["R"], planes["G"], planes["B"])]
elif kind == "normal":  # [-1, 1] becomes [0, 255]
    pixels = [tuple(round(127.5 * v + 127.5) for v in p) if any(p) else (0, 0, 0) for p in zip(planes["X"], planes["Y"], planes["Z"])]
elif kind == "depth":  # near is bright, nothing is black
    known = [z for z in planes["Z"] if z < 1e30]
    near, far = min(known), sorted(known)[len(known) * 99 // 100]
    pixels = [(round(255 - 215 * min(1.0, (z - near) / (far - near))),) * 3 if z < 1e30 else (0, 0, 0) for z in planes["Z"]]
else:  # a triangle's index: a colour of its own, nothing is black
    shade = lambda n, k: 70 + (n * 2654435761 + n * n * k >> 7) % 186
    pixels = [tuple(shade(int(n), k) for k in (3, 7, 11)) if n >= 0 else (0, 0, 0) for n in planes["triangle"]]

rows = b"".join(b"\0" + bytes(v for p in pixels[y * width:(y + 1) * width] for v in p) for y in range(height))
chunk = lambda tag, body: struct.pack(">I", len(body)) + tag + body + struct.pack(">I", zlib.crc32(tag + body))
with open(target, "wb") as file:
    file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)) +
               chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b""))
PYTHON
}

# Deflates a PNG's pixels once more, harder than the program does; the picture stays what it is.
shrink() {
    python3 - "$@" << 'PYTHON'
import struct, sys, zlib

chunk = lambda tag, body: struct.pack(">I", len(body)) + tag + body + struct.pack(">I", zlib.crc32(tag + body))
for name in sys.argv[1:]:
    data = open(name, "rb").read()
    at, header, packed = 8, b"", b""
    while at < len(data):
        length, tag = struct.unpack_from(">I4s", data, at)
        body = data[at + 8:at + 8 + length]
        header, packed = header + body if tag == b"IHDR" else header, packed + body if tag == b"IDAT" else packed
        at += 12 + length
    with open(name, "wb") as file:
        file.write(data[:8] + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(zlib.decompress(packed), 9)) + chunk(b"IEND", b""))
PYTHON
}

# docs/frame.md: the stages of a frame of builtin:glass.
"$program" render builtin:glass -o "$work/glass.png" --size 400x320 --tracer none --aov triangle,normal,albedo,depth
for kind in triangle normal albedo depth; do
    aov_to_png "$kind" "$work/glass.$kind.exr" "docs/frame_$kind.png"
done
figure frame_untraced builtin:glass --tracer none
figure frame_cubemap builtin:glass --tracer cubemap
for bounces in 0 1 4; do figure "frame_bounces_$bounces" builtin:glass --bounces "$bounces"; done

# docs/scenes.md: the built-in scenes (builtin:glass is frame_bounces_4.png).
figure scene_teapots builtin:teapots
figure scene_tree builtin:tree
figure scene_leaves builtin:leaves
figure scene_desk builtin:desk --spp 16
figure scene_kitchen builtin:kitchen
figure scene_bricks builtin:bricks
figure scene_cloth builtin:cloth --time 2
figure scene_blob builtin:blob:20000
"$program" render builtin:walker -o docs/scene_walker.png --size 260x208 --spp 4 --animation walk --time 1.4
figure scene_waves builtin:waves --time 1.5
figure scene_particles builtin:particles --time 1.5

# docs/animation.md: a turntable in four frames.
if command -v ffmpeg > /dev/null; then
    "$program" render builtin:teapots -o "$work/turn_%d.png" --turntable 4 --size 240x192 --spp 4
    ffmpeg -loglevel error -y -i "$work/turn_%d.png" -vf tile=4x1:padding=4:color=white -frames:v 1 docs/turntable.png
else
    echo "figures: there is no ffmpeg: docs/turntable.png stays as it is" >&2
fi

# README.md and docs/accuracy.md: the paper's comparison, and the worst pixels.
"$program" compare builtin:teapots -o "$work/report.html" --size 480x384 --tracers cubemap,ldc,reference --strip docs/comparison.png
for scene in teapots tree; do
    "$program" compare "builtin:$scene" -o "$work/report.html" --tracers ldc,reference --hit exact,planar --ldc 1024 \
        --worst "docs/worst_$scene.png"
done
shrink docs/comparison.png docs/worst_*.png

if [ "${2:-}" = readme ]; then
    effects=reflection,refraction,shadow,ambient
    "$program" render builtin:glass -o docs/glass.png --size 960x600 --exposure 0.1 --spp 256 --bounces 10 --effects $effects
    "$program" render builtin:teapots -o docs/teapots.png --size 960x600 --eye 0.3,2.75,5.6 --look -0.02,0.32,0.1 --fov 36 \
        --exposure 0.2 --spp 256 --effects $effects
    shrink docs/glass.png docs/teapots.png
    if command -v ffmpeg > /dev/null; then
        "$program" render builtin:walker -o "$work/w_%03d.png" --frames 0:114 --fps 15 --size 400x300 --spp 64
        ffmpeg -loglevel error -y -framerate 15 -i "$work/w_%03d.png" -c:v libwebp_anim -quality 70 -compression_level 6 -loop 0 \
            docs/walker.webp
    else
        echo "figures: there is no ffmpeg: docs/walker.webp stays as it is" >&2
    fi
fi

shrink docs/frame_bounces_*.png docs/frame_untraced.png docs/frame_cubemap.png docs/scene_*.png docs/turntable.png
