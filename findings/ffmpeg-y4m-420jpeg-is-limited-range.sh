#!/bin/bash
# A YUV4MPEG2 stream that says C420jpeg is read with video's limited range, not with JPEG's full one.
#
# version    ffmpeg N-47683-g0e8eb07980 of @ffmpeg-installer/linux-x64 4.1.0 (npm); the same with Debian's 5.1.9
# guess      "420jpeg" is YUV as JPEG has it: samples in the middle of four pixels and levels from 0 to 255.
# behaviour  The word tells where chroma lies, and nothing of levels: they are taken to go from 16 to 235, as with
#            C420mpeg2. Only the comment XCOLORRANGE=FULL, which the format's description does not know, makes them full.
#            A writer that converts by JPEG's matrix and writes C420jpeg alone gets pictures of too much contrast.
# seen       luma 235 shown as: C420jpeg 255; C420jpeg XCOLORRANGE=FULL 235; C420mpeg2 255
# source     libavformat/yuv4mpegdec.c: "420jpeg" sets AVCHROMA_LOC_CENTER; color_range comes from XCOLORRANGE alone.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm init -y > npm.log
npm install --silent --no-audit --no-fund @ffmpeg-installer/linux-x64@4.1.0 >> npm.log
ffmpeg=node_modules/@ffmpeg-installer/linux-x64/ffmpeg

# Two by two grey pixels of luma 235: what they become.
shown() {
    { printf 'YUV4MPEG2 W2 H2 F25:1 Ip A1:1 %s\nFRAME\n' "$1"; printf '\353\353\353\353\200\200'; } > frame.y4m
    "$ffmpeg" -v error -i frame.y4m -pix_fmt rgb24 -f rawvideo - | od -An -tu1 -N1 | tr -d ' '
}
seen="C420jpeg $(shown C420jpeg); C420jpeg XCOLORRANGE=FULL $(shown 'C420jpeg XCOLORRANGE=FULL'); C420mpeg2 $(shown C420mpeg2)"
echo "$("$ffmpeg" -version | sed -n '1s/ Copyright.*//p'): luma 235 shown as: $seen"
[ "$seen" = 'C420jpeg 255; C420jpeg XCOLORRANGE=FULL 235; C420mpeg2 255' ]
