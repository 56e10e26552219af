#!/bin/bash
# meshoptimizer's index codec gives back triangles whose corners are rotated.
#
# version    meshoptimizer 1.3.0 (npm); the codec of EXT_meshopt_compression, mode TRIANGLES
# guess      A lossless codec returns the numbers that went in.
# behaviour  The triangles and their order stay, their first corner does not: 2 1 0 comes back as 0 2 1. Whatever
#            refers to corners by position (barycentric coordinates of a hit, flat attributes of a provoking vertex)
#            means something else after the round trip. The mode INDICES of the same library is exact.
# seen       TRIANGLES: 2 1 0, 3 1 2, 5 0 4 -> 0 2 1, 1 2 3, 5 0 4; INDICES: unchanged
# source     meshoptimizer, src/indexcodec.cpp: rotateTriangle, called by meshopt_encodeIndexBuffer so that an edge or a
#            vertex that was seen lately comes first.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm init -y > npm.log
npm install --silent --no-audit --no-fund meshoptimizer@1.3.0 >> npm.log
cat > codec.mjs <<'JS'
import { MeshoptDecoder, MeshoptEncoder } from 'meshoptimizer';

await Promise.all([MeshoptEncoder.ready, MeshoptDecoder.ready]);
const input = new Uint32Array([2, 1, 0, 3, 1, 2, 5, 0, 4]);
const bytes = new Uint8Array(input.buffer);
function decoded(decode, packed) {
  const output = new Uint8Array(bytes.length);
  decode(output, input.length, 4, packed);
  return new Uint32Array(output.buffer).join(' ');
}
console.log(input.join(' '));
console.log('TRIANGLES', decoded(MeshoptDecoder.decodeIndexBuffer, MeshoptEncoder.encodeIndexBuffer(bytes, input.length, 4)));
console.log('INDICES', decoded(MeshoptDecoder.decodeIndexSequence, MeshoptEncoder.encodeIndexSequence(bytes, input.length, 4)));
JS
seen=$(node codec.mjs 2>&1)
echo "meshoptimizer 1.3.0:"
echo "$seen"
[ "$seen" = $'2 1 0 3 1 2 5 0 4\nTRIANGLES 0 2 1 1 2 3 5 0 4\nINDICES 2 1 0 3 1 2 5 0 4' ]
