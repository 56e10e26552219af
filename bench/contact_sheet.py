#!/usr/bin/env python3
"""Renders every glTF file of some folders and lays the pictures out beside the authors' own, for looking at them all.

    bench/contact_sheet.py --program build/release/peelray --models ../shared/models/gltf ../shared/models/skinned --out out/contact

Writes OUT/index.html with the pictures, the notes and the lines of files that were refused; with ImageMagick (`montage`) also
OUT/sheet_1.png, ... The authors' pictures are those of the folders' reference/, by name. Pictures are 480x360, one sample per pixel,
from the file's first camera or the default view; --options "..." changes that. Exit status: 0, also where files are refused.
"""
import argparse
import html
import os
import shlex
import shutil
import subprocess
import sys


def files_of(folder):
    """Name and path of each glTF file, folder by folder; one that is there in several encodings counts once."""
    found = {}
    for root, folders, names in sorted(os.walk(folder)):
        folders.sort()
        if os.path.basename(root) == "reference":
            continue
        for name in sorted(names):
            stem, extension = os.path.splitext(name)
            if extension in (".glb", ".gltf"):
                found.setdefault(os.path.relpath(os.path.join(root, stem), folder), os.path.join(root, name))
    return found


def reference_of(folder, name):
    stem = os.path.basename(name)
    for extension in (".png", ".jpg"):
        path = os.path.join(folder, "reference", stem + extension)
        if os.path.exists(path):
            return path
    return None


def render(program, path, picture, options):
    """The program's lines; whether there is a picture."""
    done = subprocess.run([program, "render", path, "-o", picture] + options, capture_output=True, text=True)
    return (done.stderr + done.stdout).strip().splitlines(), done.returncode == 0


def montage(out, entries):
    """Sheets of 6 x 5 pictures, each with its name; the authors' right of ours."""
    tiles = []
    for name, picture, reference, _ in entries:
        for label, path in ((name, picture), (name + " (authors)", reference)):
            if path:
                tiles += ["-label", label, path]
    for i in range(0, len(tiles), 90):
        subprocess.run(["montage", "-geometry", "320x240+4+4", "-tile", "6x", "-background", "white"] + tiles[i:i + 90] +
                       [os.path.join(out, f"sheet_{i // 90 + 1}.png")], check=True)


def page(entries):
    rows = []
    for name, picture, reference, lines in entries:
        pictures = f'<img src="{html.escape(os.path.basename(picture))}">' if picture else "refused"
        authors = f'<img src="{html.escape(os.path.basename(reference))}" height="360">' if reference else ""
        rows.append(f"<tr><td>{html.escape(name)}<td>{pictures}<td>{authors}<td>{'<br>'.join(html.escape(line) for line in lines)}")
    return ("<!doctype html><meta charset=utf-8><title>Contact sheet</title><style>td{vertical-align:top;padding:4px;font:13px sans-serif}"
            "</style><table><tr><th>file<th>picture<th>authors'<th>what the program says\n" + "\n".join(rows) + "</table>\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default="build/release/peelray")
    parser.add_argument("--models", nargs="+", default=["../shared/models/gltf", "../shared/models/skinned"])
    parser.add_argument("--out", default="out/contact")
    parser.add_argument("--only", help="files whose name contains this")
    parser.add_argument("--options", default="--size 480x360", help="of each render")
    arguments = parser.parse_args()
    os.makedirs(arguments.out, exist_ok=True)
    entries = []
    for folder in arguments.models:
        if not os.path.isdir(folder):
            print(f"left out: there is no folder {folder}", file=sys.stderr)
            continue
        for name, path in files_of(folder).items():
            if arguments.only and arguments.only not in name:
                continue
            picture = os.path.join(arguments.out, name.replace("/", "_") + ".png")
            lines, is_there = render(arguments.program, path, picture, shlex.split(arguments.options))
            reference = reference_of(folder, name)
            if reference:
                copy = os.path.join(arguments.out, "authors_" + os.path.basename(reference))
                shutil.copyfile(reference, copy)
                reference = copy
            entries.append((name, picture if is_there else None, reference, lines))
            print(f"{name}: {'done' if is_there else 'refused'}", flush=True)
    with open(os.path.join(arguments.out, "index.html"), "w", encoding="utf-8") as file:
        file.write(page(entries))
    if shutil.which("montage"):
        montage(arguments.out, entries)
    else:
        print("no sheets: ImageMagick's montage is missing", file=sys.stderr)


if __name__ == "__main__":
    main()
